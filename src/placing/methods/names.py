"""The methods that arrange, by the names they go by everywhere (Figure 6)."""

METHODS = (
    *("chance", "height", "room", "area", "random_human"),
    *("object", "fmm", "dp", "dp_object"),
)
"""In the order of tables and figures, that of the paper's Figure 6."""
HUMAN_METHODS = ("random_human", "fmm", "dp", "dp_object")
"""The methods whose density goes through human poses."""
LABELS = "labels"
"""What answers with another labelled arrangement, beside the methods."""
ORDER = (*METHODS, LABELS)
"""The rows of tables and the bars of figures."""
JOINT_NAMES = {
    "object_context": "object context",
    "fmm": "human context (FMM)",
    "dp": "human context (DP)",
    "dp_object_context": "DP + object context",
}
"""The methods that arrange all objects together, by what Table 2 calls them."""
JOINT_METHODS = tuple(JOINT_NAMES)
