"""The whole study: rooms, placing areas, human poses, arrangements, figure 6.

Run it with `./run snakemake -j2`. The folds are data (`config/scenes.csv`), so the
graph is known before anything has run.
"""

from snakemake.utils import min_version

min_version("9.0")


configfile: "config/config.yaml"


include: "workflow/rules/common.smk"


rule all:
    """Compute every table, figure, picture and recording, and check them."""
    input:
        leaves(),
        "results/run.json",


include: "workflow/rules/scenes.smk"
include: "workflow/rules/placing.smk"
include: "workflow/rules/stability.smk"
include: "workflow/rules/semantics.smk"
include: "workflow/rules/joint.smk"
include: "workflow/rules/rating.smk"
include: "workflow/rules/robot.smk"
include: "workflow/rules/scenarios.smk"
include: "workflow/rules/recording_joint.smk"
include: "workflow/rules/recording_plan.smk"
include: "workflow/rules/figure6.smk"
include: "workflow/rules/pictures.smk"
include: "workflow/rules/checks.smk"
