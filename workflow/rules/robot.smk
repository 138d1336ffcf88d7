"""The robot of Section 3.3 in some scenes of every data set, and Table 1.

INPUTS

    results/{dataset}/scenes/fold{fold}/                     placing areas, objects
    results/{dataset}/clouds/fold{fold}/                     what the planner sees
    results/{dataset}/options/{task}/fold{fold}.parquet      what it chooses among
    results/{dataset}/arrangements/{task}/fold{fold}.parquet what it is compared with
    resources/rooms/{scene}.yaml, the wheel of procthor      what is really there

OUTPUTS

    results/{dataset}/bodies/                                {scene}.npz
    results/{dataset}/plans/fold{fold}.parquet               where, in which order
    results/{dataset}/tried/fold{fold}.parquet               every placement tried
    results/{dataset}/certificates/fold{fold}/               how, to be replayed
    results/{dataset}/tables/table1.csv, table1.md           as the paper prints it
    results/{dataset}/tables/table1_long.csv                 with standard errors
    results/{dataset}/tables/table1_paired.csv               over the same objects
    results/{dataset}/tables/table1_reasons.csv              why not placed
"""


rule cut_bodies:
    """Cut what is in the robot's scenes into the solids that a simulator takes."""
    input:
        scenes=of_every_fold("results/{dataset}/scenes/fold{fold}"),
        rooms=room_files,
        room_schema="workflow/schemas/room.schema.yaml",
        catalogue="config/objects.csv",
        types="config/thor_types.csv",
    output:
        bodies=directory("results/{dataset}/bodies"),
    log:
        "results/logs/cut_bodies/{dataset}.log",
    benchmark:
        "results/benchmarks/cut_bodies/{dataset}.tsv"
    params:
        code=digest("cut_bodies"),
        rooms=folder_of,
        robot_scenes=robot_scenes,
        margin_m=config["settling"]["margin_m"],
    shell:
        r"""
        python workflow/scripts/cut_bodies.py \
            --dataset {wildcards.dataset:q} \
            --scenes {input.scenes:q} \
            --robot-scenes {params.robot_scenes:q} \
            --layouts {params.rooms:q} {input.room_schema:q} \
            {input.catalogue:q} {input.types:q} \
            --bodies {output.bodies:q} \
            --margin-m {params.margin_m:q} \
            2>{log:q}
        """


rule plan_placing:
    """Plan how the robot places the objects of a fold, and in which order."""
    input:
        scenes="results/{dataset}/scenes/fold{fold}",
        clouds="results/{dataset}/clouds/fold{fold}",
        bodies="results/{dataset}/bodies",
        options=of_tasks("results/{dataset}/options/{task}/fold{fold}.parquet"),
        robot="config/robots/pr2.yaml",
        robot_schema="workflow/schemas/robot.schema.yaml",
        grasps="config/grasps.csv",
        grasps_schema="workflow/schemas/grasps.schema.yaml",
    output:
        plans="results/{dataset}/plans/fold{fold}.parquet",
        tried="results/{dataset}/tried/fold{fold}.parquet",
        certificates=directory("results/{dataset}/certificates/fold{fold}"),
    log:
        "results/logs/plan_placing/{dataset}/fold{fold}.log",
    benchmark:
        "results/benchmarks/plan_placing/{dataset}/fold{fold}.tsv"
    params:
        code=digest("plan_placing"),
        seed=config["seed"],
        robot_scenes=robot_scenes,
        min_distance_m=config["decision"]["min_distance_m"],
        robot_placing=flags("robot_placing"),
        settings=flags("checking", "planning", "settling", within="settings."),
    shell:
        r"""
        python workflow/scripts/plan_placing.py \
            --dataset {wildcards.dataset:q} \
            --scenes {input.scenes:q} \
            --clouds {input.clouds:q} \
            --options {input.options:q} \
            --robot-scenes {params.robot_scenes:q} \
            --bodies {input.bodies:q} \
            --robot {input.robot:q} {input.robot_schema:q} \
            --grasps {input.grasps:q} {input.grasps_schema:q} \
            --plans {output.plans:q} \
            --tried {output.tried:q} \
            --certificates {output.certificates:q} \
            --seed {params.seed:q} \
            --min-distance-m {params.min_distance_m:q} \
            {params.robot_placing:q} \
            {params.settings:q} \
            2>{log:q}
        """


rule tabulate_table1:
    """Compare errors with and without the constraints of the robot."""
    input:
        scenes=of_every_fold("results/{dataset}/scenes/fold{fold}"),
        arrangements=of_every_fold(
            "results/{dataset}/arrangements/{task}/fold{fold}.parquet"
        ),
        plans=of_every_fold("results/{dataset}/plans/fold{fold}.parquet"),
        paper="config/paper.csv",
    output:
        table="results/{dataset}/tables/table1.csv",
        long="results/{dataset}/tables/table1_long.csv",
        paired="results/{dataset}/tables/table1_paired.csv",
        reasons="results/{dataset}/tables/table1_reasons.csv",
        markdown="results/{dataset}/tables/table1.md",
    log:
        "results/logs/tabulate_table1/{dataset}.log",
    benchmark:
        "results/benchmarks/tabulate_table1/{dataset}.tsv"
    params:
        code=digest("tabulate_table1"),
        seed=config["seed"],
    shell:
        r"""
        python workflow/scripts/tabulate_table1.py \
            --dataset {wildcards.dataset:q} \
            --scenes {input.scenes:q} \
            --arrangements {input.arrangements:q} \
            --plans {input.plans:q} \
            --paper {input.paper:q} \
            --seed {params.seed:q} \
            --table {output.table:q} \
            --long {output.long:q} \
            --paired {output.paired:q} \
            --reasons {output.reasons:q} \
            --markdown {output.markdown:q} \
            2>{log:q}
        """
