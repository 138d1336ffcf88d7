"""Learn how people use objects in the other folds, then arrange the scenes of a fold.

`held_out` names the folds that are not learned from: the fold whose scenes are
arranged, and for choosing numbers and calibrating regions one more.

INPUTS

    results/{dataset}/scenes/fold{fold}/                     placing areas, objects
    results/{dataset}/features/fold{fold}/                   candidates

OUTPUTS

    results/{dataset}/theta/{held_out}/                      {method}.json
    results/{dataset}/tuning/fold{fold}.json                 K, omega, ranks
    results/{dataset}/arrangements/{task}/fold{fold}.parquet
    results/{dataset}/likelihoods/{task}/fold{fold}.parquet  of the labelled places
    results/{dataset}/poses/{task}/fold{fold}.parquet        samples of the first chain
    results/{dataset}/densities/{task}/fold{fold}/           {scene}.npz
    results/{dataset}/traces/{task}/fold{fold}.parquet       every sweep of every chain
    results/{dataset}/diagnostics/{task}/fold{fold}.parquet
    results/{dataset}/explanations/{task}/fold{fold}.parquet
    results/{dataset}/options/{task}/fold{fold}.parquet      for the robot
    results/{dataset}/scores/{task}/fold{fold}.parquet
    results/{dataset}/fold{fold}.csv
"""


rule learn_theta:
    """Learn what every method needs from the scenes of the folds not held out."""
    input:
        scenes=of_folds_left("results/{dataset}/scenes/fold{fold}"),
        features=of_folds_left("results/{dataset}/features/fold{fold}"),
    output:
        theta=directory("results/{dataset}/theta/{held_out}"),
    log:
        "results/logs/learn_theta/{dataset}/{held_out}.log",
    benchmark:
        "results/benchmarks/learn_theta/{dataset}/{held_out}.tsv"
    params:
        code=digest("learn_theta"),
        seed=config["seed"],
        n_components=config["tuning"]["n_components"],
        settings=flags("sampling", "learning", "fitting", "baselines", "object_context"),
    shell:
        r"""
        python workflow/scripts/learn_theta.py \
            --dataset {wildcards.dataset:q} \
            --held-out {wildcards.held_out:q} \
            --scenes {input.scenes:q} \
            --features {input.features:q} \
            --theta {output.theta:q} \
            --seed {params.seed:q} \
            --n-components {params.n_components:q} \
            {params.settings:q} \
            2>{log:q}
        """


rule tune_methods:
    """Choose K and omega of a fold on its training scenes, and calibrate regions."""
    input:
        theta=of_pairs("results/{dataset}/theta/{held_out}"),
        scenes=of_other_folds("results/{dataset}/scenes/fold{fold}"),
        features=of_other_folds("results/{dataset}/features/fold{fold}"),
    output:
        tuning="results/{dataset}/tuning/fold{fold}.json",
    log:
        "results/logs/tune_methods/{dataset}/fold{fold}.log",
    benchmark:
        "results/benchmarks/tune_methods/{dataset}/fold{fold}.tsv"
    params:
        code=digest("tune_methods"),
        seed=config["seed"],
        settings=flags(*ANSWERING, within="settings."),
        tuning=flags("tuning", "scoring"),
    shell:
        r"""
        python workflow/scripts/tune_methods.py \
            --dataset {wildcards.dataset:q} \
            --fold {wildcards.fold:q} \
            --theta {input.theta:q} \
            --scenes {input.scenes:q} \
            --features {input.features:q} \
            --tuning-file {output.tuning:q} \
            --seed {params.seed:q} \
            {params.settings:q} \
            {params.tuning:q} \
            2>{log:q}
        """


rule sample_arrangement:
    """Sample human poses in the scenes of a fold and arrange the objects by them.

    Both tasks at once, since they share what is computed of a scene.
    """
    input:
        theta="results/{dataset}/theta/fold{fold}",
        tuning="results/{dataset}/tuning/fold{fold}.json",
        scenes="results/{dataset}/scenes/fold{fold}",
        features="results/{dataset}/features/fold{fold}",
    output:
        arrangements=of_tasks(
            "results/{dataset}/arrangements/{task}/fold{fold}.parquet"
        ),
        likelihoods=of_tasks("results/{dataset}/likelihoods/{task}/fold{fold}.parquet"),
        poses=of_tasks("results/{dataset}/poses/{task}/fold{fold}.parquet"),
        densities=directory(of_tasks("results/{dataset}/densities/{task}/fold{fold}")),
        traces=of_tasks("results/{dataset}/traces/{task}/fold{fold}.parquet"),
        diagnoses=of_tasks("results/{dataset}/diagnostics/{task}/fold{fold}.parquet"),
        explanations=of_tasks(
            "results/{dataset}/explanations/{task}/fold{fold}.parquet"
        ),
        options=of_tasks("results/{dataset}/options/{task}/fold{fold}.parquet"),
    log:
        "results/logs/sample_arrangement/{dataset}/fold{fold}.log",
    benchmark:
        "results/benchmarks/sample_arrangement/{dataset}/fold{fold}.tsv"
    params:
        code=digest("sample_arrangement"),
        seed=config["seed"],
        robot_scenes=robot_scenes,
        settings=flags(*ANSWERING, within="settings."),
        scoring=flags("scoring", "offering"),
    shell:
        r"""
        python workflow/scripts/sample_arrangement.py \
            --dataset {wildcards.dataset:q} \
            --theta {input.theta:q} \
            --tuning {input.tuning:q} \
            --scenes {input.scenes:q} \
            --features {input.features:q} \
            --arrangements {output.arrangements:q} \
            --likelihoods {output.likelihoods:q} \
            --poses {output.poses:q} \
            --densities {output.densities:q} \
            --traces {output.traces:q} \
            --diagnoses {output.diagnoses:q} \
            --explanations {output.explanations:q} \
            --options {output.options:q} \
            --robot-scenes {params.robot_scenes:q} \
            --seed {params.seed:q} \
            {params.settings:q} \
            {params.scoring:q} \
            2>{log:q}
        """


rule score_arrangement:
    """Measure how far the arrangements of a fold are from the labelled ones."""
    input:
        scenes="results/{dataset}/scenes/fold{fold}",
        arrangements="results/{dataset}/arrangements/{task}/fold{fold}.parquet",
        likelihoods="results/{dataset}/likelihoods/{task}/fold{fold}.parquet",
    output:
        scores="results/{dataset}/scores/{task}/fold{fold}.parquet",
    log:
        "results/logs/score_arrangement/{dataset}/{task}/fold{fold}.log",
    benchmark:
        "results/benchmarks/score_arrangement/{dataset}/{task}/fold{fold}.tsv"
    params:
        code=digest("score_arrangement"),
    shell:
        r"""
        python workflow/scripts/score_arrangement.py \
            --dataset {wildcards.dataset:q} \
            --task {wildcards.task:q} \
            --scenes {input.scenes:q} \
            --arrangements {input.arrangements:q} \
            --likelihoods {input.likelihoods:q} \
            --scores {output.scores:q} \
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
