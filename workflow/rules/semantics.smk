"""Psi_semantics of Section 3.1: on which placing areas objects belong.

INPUTS

    results/{dataset}/scenes/fold{fold}/                 placing areas, labels
    results/{dataset}/features/fold{fold}/               candidates
    results/{dataset}/clouds/fold{fold}/                 what is around the areas

OUTPUTS

    results/{dataset}/semantics/{held_out}.json          the model
    results/{dataset}/tables/semantics.csv               held-out hit rates
"""


rule learn_semantics:
    """Learn where objects belong from the scenes of the folds not held out."""
    input:
        scenes=of_folds_left("results/{dataset}/scenes/fold{fold}"),
        features=of_folds_left("results/{dataset}/features/fold{fold}"),
        clouds=of_folds_left("results/{dataset}/clouds/fold{fold}"),
    output:
        model="results/{dataset}/semantics/{held_out}.json",
    log:
        "results/logs/learn_semantics/{dataset}/{held_out}.log",
    benchmark:
        "results/benchmarks/learn_semantics/{dataset}/{held_out}.tsv"
    params:
        code=digest("learn_semantics"),
        seed=config["seed"],
        settings=flags("looking", "semantics"),
    shell:
        r"""
        python workflow/scripts/learn_semantics.py \
            --dataset {wildcards.dataset:q} \
            --held-out {wildcards.held_out:q} \
            --scenes {input.scenes:q} \
            --features {input.features:q} \
            --clouds {input.clouds:q} \
            --model {output.model:q} \
            --seed {params.seed:q} \
            {params.settings:q} \
            2>{log:q}
        """


rule tabulate_semantics:
    """Tell how often the area that a labeller chose is among the most probable."""
    input:
        models=of_every_fold("results/{dataset}/semantics/fold{fold}.json"),
        theta=of_every_fold("results/{dataset}/theta/fold{fold}"),
        scenes=of_every_fold("results/{dataset}/scenes/fold{fold}"),
        features=of_every_fold("results/{dataset}/features/fold{fold}"),
        clouds=of_every_fold("results/{dataset}/clouds/fold{fold}"),
    output:
        table="results/{dataset}/tables/semantics.csv",
    log:
        "results/logs/tabulate_semantics/{dataset}.log",
    benchmark:
        "results/benchmarks/tabulate_semantics/{dataset}.tsv"
    params:
        code=digest("tabulate_semantics"),
        settings=flags("looking", "baselines"),
    shell:
        r"""
        python workflow/scripts/tabulate_semantics.py \
            --models {input.models:q} \
            --theta {input.theta:q} \
            --scenes {input.scenes:q} \
            --features {input.features:q} \
            --clouds {input.clouds:q} \
            --table {output.table:q} \
            {params.settings:q} \
            2>{log:q}
        """
