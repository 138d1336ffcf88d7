"""Learn from rigid-body simulation which placements stay put (Section 3.1).

INPUTS

    config/objects.csv                   the objects

OUTPUTS

    results/stability/trials.parquet     placements that were tried, and what they did
    results/stability/model.json         what was learned from them
    results/stability/chosen.parquet     what it chose for the report, settled again
    results/stability/table.csv, .md     how well it knows new objects and new areas
"""

TRYING = ("cloud", "orientations", "looking", "trials", "settling")


rule run_trials:
    """Put objects down on pieces of furniture and watch whether they stay."""
    input:
        catalogue="config/objects.csv",
    output:
        trials="results/stability/trials.parquet",
    log:
        "results/logs/run_trials.log",
    benchmark:
        "results/benchmarks/run_trials.tsv"
    threads: 2
    params:
        code=digest("run_trials"),
        seed=config["seed"],
        spacing_m=config["scan"]["spacing_m"],
        reach_m=config["putting_down"]["reach_m"],
        settings=flags(*TRYING, within="settings."),
    shell:
        r"""
        python workflow/scripts/run_trials.py \
            --catalogue {input.catalogue:q} \
            --trials-file {output.trials:q} \
            --seed {params.seed:q} \
            --spacing-m {params.spacing_m:q} \
            --reach-m {params.reach_m:q} \
            --n-workers {threads} \
            {params.settings:q} \
            2>{log:q}
        """


rule learn_stability:
    """Learn which placements stay, and settle what is chosen by it once more."""
    input:
        catalogue="config/objects.csv",
        trials="results/stability/trials.parquet",
    output:
        model="results/stability/model.json",
        chosen="results/stability/chosen.parquet",
        table="results/stability/table.csv",
        markdown="results/stability/table.md",
    log:
        "results/logs/learn_stability.log",
    benchmark:
        "results/benchmarks/learn_stability.tsv"
    params:
        code=digest("learn_stability"),
        seed=config["seed"],
        spacing_m=config["scan"]["spacing_m"],
        reach_m=config["putting_down"]["reach_m"],
        settings=flags(*TRYING, within="settings."),
        stability=flags("stability"),
    shell:
        r"""
        python workflow/scripts/learn_stability.py \
            --catalogue {input.catalogue:q} \
            --trials-file {input.trials:q} \
            --model {output.model:q} \
            --chosen-file {output.chosen:q} \
            --table {output.table:q} \
            --markdown {output.markdown:q} \
            --seed {params.seed:q} \
            --spacing-m {params.spacing_m:q} \
            --reach-m {params.reach_m:q} \
            --n-workers {threads} \
            {params.settings:q} \
            {params.stability:q} \
            2>{log:q}
        """
