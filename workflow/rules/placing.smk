"""Learn how people use objects in the other folds, then arrange the scenes of a fold.

INPUTS

    results/{dataset}/scenes/fold{fold}/                     placing areas, objects
    results/{dataset}/features/fold{fold}/                   candidates

OUTPUTS

    results/{dataset}/theta/fold{fold}/                      {method}.json
    results/{dataset}/arrangements/{task}/fold{fold}.parquet
    results/{dataset}/poses/{task}/fold{fold}.parquet
    results/{dataset}/densities/{task}/fold{fold}/           {scene}.npz
    results/{dataset}/scores/{task}/fold{fold}.parquet
    results/{dataset}/fold{fold}.csv
"""


rule learn_theta:
    """Learn the potentials of every method from the scenes of the other folds."""
    input:
        scenes=of_other_folds("results/{dataset}/scenes/fold{fold}"),
        features=of_other_folds("results/{dataset}/features/fold{fold}"),
    output:
        theta=directory("results/{dataset}/theta/fold{fold}"),
    log:
        "results/logs/learn_theta/{dataset}/fold{fold}.log",
    benchmark:
        "results/benchmarks/learn_theta/{dataset}/fold{fold}.tsv"
    params:
        code=digest("learn_theta"),
        seed=config["seed"],
        settings=flags("sampling", "learning", "fitting", "baselines"),
    shell:
        r"""
        python workflow/scripts/learn_theta.py \
            --dataset {wildcards.dataset:q} \
            --fold {wildcards.fold:q} \
            --scenes {input.scenes:q} \
            --features {input.features:q} \
            --theta {output.theta:q} \
            --seed {params.seed:q} \
            {params.settings:q} \
            2>{log:q}
        """


rule sample_arrangement:
    """Sample human poses in the scenes of a fold and arrange the objects by them."""
    input:
        theta="results/{dataset}/theta/fold{fold}",
        scenes="results/{dataset}/scenes/fold{fold}",
        features="results/{dataset}/features/fold{fold}",
    output:
        arrangements="results/{dataset}/arrangements/{task}/fold{fold}.parquet",
        poses="results/{dataset}/poses/{task}/fold{fold}.parquet",
        densities=directory("results/{dataset}/densities/{task}/fold{fold}"),
    log:
        "results/logs/sample_arrangement/{dataset}/{task}/fold{fold}.log",
    benchmark:
        "results/benchmarks/sample_arrangement/{dataset}/{task}/fold{fold}.tsv"
    params:
        code=digest("sample_arrangement"),
        seed=config["seed"],
        settings=flags(
            "candidates",
            "sampling",
            "arranging",
            "decision",
            "baselines",
            within="settings.",
        ),
    shell:
        r"""
        python workflow/scripts/sample_arrangement.py \
            --dataset {wildcards.dataset:q} \
            --task {wildcards.task:q} \
            --theta {input.theta:q} \
            --scenes {input.scenes:q} \
            --features {input.features:q} \
            --arrangements {output.arrangements:q} \
            --poses {output.poses:q} \
            --densities {output.densities:q} \
            --seed {params.seed:q} \
            {params.settings:q} \
            2>{log:q}
        """


rule score_arrangement:
    """Measure how far the arrangements of a fold are from the labelled ones."""
    input:
        scenes="results/{dataset}/scenes/fold{fold}",
        features="results/{dataset}/features/fold{fold}",
        arrangements="results/{dataset}/arrangements/{task}/fold{fold}.parquet",
        densities="results/{dataset}/densities/{task}/fold{fold}",
    output:
        scores="results/{dataset}/scores/{task}/fold{fold}.parquet",
    log:
        "results/logs/score_arrangement/{dataset}/{task}/fold{fold}.log",
    benchmark:
        "results/benchmarks/score_arrangement/{dataset}/{task}/fold{fold}.tsv"
    params:
        code=digest("score_arrangement"),
        spacing_m=config["candidates"]["spacing_m"],
        scoring=flags("scoring"),
    shell:
        r"""
        python workflow/scripts/score_arrangement.py \
            --dataset {wildcards.dataset:q} \
            --task {wildcards.task:q} \
            --scenes {input.scenes:q} \
            --features {input.features:q} \
            --arrangements {input.arrangements:q} \
            --densities {input.densities:q} \
            --scores {output.scores:q} \
            --spacing-m {params.spacing_m:q} \
            {params.scoring:q} \
            2>{log:q}
        """


rule summarise_fold:
    """Average the errors of one fold: the target that computes a fold alone."""
    input:
        scores=expand(
            "results/{{dataset}}/scores/{task}/fold{{fold}}.parquet", task=TASKS
        ),
    output:
        summary="results/{dataset}/fold{fold}.csv",
    log:
        "results/logs/summarise_fold/{dataset}/fold{fold}.log",
    benchmark:
        "results/benchmarks/summarise_fold/{dataset}/fold{fold}.tsv"
    params:
        code=digest("summarise_fold"),
    shell:
        r"""
        python workflow/scripts/summarise_fold.py \
            --scores {input.scores:q} \
            --summary {output.summary:q} \
            2>{log:q}
        """
