"""Settings of the joint placement of many objects."""

from dataclasses import dataclass


@dataclass(frozen=True)
class AssignmentConfig:
    """Settings of the joint placement; the values live in `config/config.yaml`."""

    n_best: int
    """Options of an object that are kept for their score."""
    n_spread: int
    """Options of an object that are kept far from each other."""
    margin_m: float
    """Between two boxes side by side."""
    max_levels: int
    """Objects of a stack."""
    max_overhang: float
    """Share of a footprint that may lie off the object below."""
    unplaced_penalty: float
    """By how much no place is worse than the worst option [nat]."""
    point_spacing_m: float
    """Lattice of points of which no two boxes may cover one."""
    n_price_steps: int
    """Steps in which these points get prices."""
    mip_rel_gap: float
    """Gap at which the search stops, relative to the sum of the losses."""
    node_limit: int
    """Nodes of HiGHS in a round."""
    n_core: int
    """Columns of the first integer program; later ones have twice as many."""
    max_core: int
    """Columns of the last one; what is left then stays in the gap."""
    n_cut_rounds: int
    """Most rounds of the linear relaxation."""
    n_rounds: int
    """Most rounds of the integer program."""
