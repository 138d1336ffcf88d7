"""Arrange empty scenes as a whole: by object context, human context and both.

Scenes of `scans` are arranged with what all folds of `rooms` teach, scenes of `rooms`
with what the other folds teach.

INPUTS

    results/stability/model.json                             Psi_stability
    results/rooms/semantics/{held_out}.json                  Psi_semantics
    results/rooms/theta/{held_out}/                          Theta
    results/rooms/tuning/fold{fold}.json                     K

OUTPUTS

    results/{dataset}/proposals/fold{fold}/                  {scene}.npz
    results/rooms/joint_tuning/{held_out}.json               omega, shares of stacks
    results/{dataset}/joint/fold{fold}.parquet
    results/{dataset}/checks/joint.csv                       does it stay put?
"""


rule propose_placements:
    """Propose placements of the objects of every empty scene of a fold."""
    input:
        theta=taught("results/rooms/theta/{held_out}"),
        tuning=tuned,
        semantics=taught("results/rooms/semantics/{held_out}.json"),
        stability="results/stability/model.json",
        clouds="results/{dataset}/clouds/fold{fold}",
        scenes="results/{dataset}/scenes/fold{fold}",
        features="results/{dataset}/features/fold{fold}",
    output:
        proposals=directory("results/{dataset}/proposals/fold{fold}"),
    log:
        "results/logs/propose_placements/{dataset}/fold{fold}.log",
    benchmark:
        "results/benchmarks/propose_placements/{dataset}/fold{fold}.tsv"
    params:
        code=digest("propose_placements"),
        seed=config["seed"],
        settings=flags(*ANSWERING, within="settings."),
        proposing=flags("orientations", "looking", "psi_object", "proposing"),
    shell:
        r"""
        python workflow/scripts/propose_placements.py \
            --dataset {wildcards.dataset:q} \
            --theta {input.theta:q} \
            --tuning {input.tuning:q} \
            --semantics {input.semantics:q} \
            --stability {input.stability:q} \
            --clouds {input.clouds:q} \
            --scenes {input.scenes:q} \
            --features {input.features:q} \
            --proposals {output.proposals:q} \
            --seed {params.seed:q} \
            {params.settings:q} \
            {params.proposing:q} \
            2>{log:q}
        """


rule tune_joint:
    """Choose omega and the shares of stacks on the scenes of the folds not held out."""
    input:
        scenes=of_folds_left("results/{dataset}/scenes/fold{fold}"),
        features=of_folds_left("results/{dataset}/features/fold{fold}"),
        proposals=of_folds_left("results/{dataset}/proposals/fold{fold}"),
    output:
        tuning="results/{dataset}/joint_tuning/{held_out}.json",
    log:
        "results/logs/tune_joint/{dataset}/{held_out}.log",
    benchmark:
        "results/benchmarks/tune_joint/{dataset}/{held_out}.tsv"
    params:
        code=digest("tune_joint"),
        spacing_m=config["candidates"]["spacing_m"],
        object_weights=config["tuning"]["object_weights"],
        scoring=flags("scoring"),
    shell:
        r"""
        python workflow/scripts/tune_joint.py \
            --scenes {input.scenes:q} \
            --features {input.features:q} \
            --proposals {input.proposals:q} \
            --tuning {output.tuning:q} \
            --spacing-m {params.spacing_m:q} \
            --object-weights {params.object_weights:q} \
            {params.scoring:q} \
            2>{log:q}
        """


rule arrange_jointly:
    """Arrange the objects of every empty scene of a fold together."""
    input:
        scenes="results/{dataset}/scenes/fold{fold}",
        features="results/{dataset}/features/fold{fold}",
        proposals="results/{dataset}/proposals/fold{fold}",
        tuning=taught("results/rooms/joint_tuning/{held_out}.json"),
    output:
        joint="results/{dataset}/joint/fold{fold}.parquet",
    log:
        "results/logs/arrange_jointly/{dataset}/fold{fold}.log",
    benchmark:
        "results/benchmarks/arrange_jointly/{dataset}/fold{fold}.tsv"
    params:
        code=digest("arrange_jointly"),
        seed=config["seed"],
        settings=flags("placing", "assignment"),
    shell:
        r"""
        python workflow/scripts/arrange_jointly.py \
            --dataset {wildcards.dataset:q} \
            --scenes {input.scenes:q} \
            --features {input.features:q} \
            --proposals {input.proposals:q} \
            --tuning {input.tuning:q} \
            --joint {output.joint:q} \
            --seed {params.seed:q} \
            {params.settings:q} \
            2>{log:q}
        """


rule settle_joint:
    """Let physics settle every joint arrangement among the true furniture."""
    input:
        joint=of_every_fold("results/{dataset}/joint/fold{fold}.parquet"),
        rooms=room_files,
        room_schema="workflow/schemas/room.schema.yaml",
        catalogue="config/objects.csv",
    output:
        checks="results/{dataset}/checks/joint.csv",
    log:
        "results/logs/settle_joint/{dataset}.log",
    benchmark:
        "results/benchmarks/settle_joint/{dataset}.tsv"
    params:
        code=digest("settle_joint"),
        rooms=folder_of,
        reach_m=config["putting_down"]["reach_m"],
        settling=flags("settling"),
    shell:
        r"""
        python workflow/scripts/settle_joint.py \
            --dataset {wildcards.dataset:q} \
            --joint {input.joint:q} \
            --rooms {params.rooms:q} \
            --schema {input.room_schema:q} \
            --catalogue {input.catalogue:q} \
            --checks {output.checks:q} \
            --reach-m {params.reach_m:q} \
            {params.settling:q} \
            2>{log:q}
        """
