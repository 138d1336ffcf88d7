"""Certificates of all that a robot places, and the scenarios of Section 4.3.

A certificate is judged in a world of its own, by nothing of the planner; one that does
not hold stops the run. Objects of the scenarios are fetched, carried and let go in
simulation, with physics.

INPUTS

    results/{dataset}/certificates/fold{fold}/               what is to be judged
    resources/scenarios/{scene}.yaml                         rooms, and where objects wait
    config/scenario_objects.csv                              the objects
    results/rooms/theta/all/                                 what all rooms teach

OUTPUTS

    results/{dataset}/checks/certificates.csv                whether each one holds
    results/scenarios/plans/fold0.parquet                    where, in which order
    results/scenarios/tried/fold0.parquet                    every placement tried
    results/scenarios/certificates/fold0/                    how
    results/scenarios/executions/{scene}.npz                 what was seen
    results/scenarios/placed/{scene}.parquet                 where objects came to rest
    results/scenarios/tables/execution.csv                   the same of all scenarios
"""


rule replay_certificates:
    """Replay every certificate of a data set; fail where one does not hold."""
    input:
        certificates=lambda w: sorted(
            f"results/{w.dataset}/certificates/fold{fold}" for fold in FOLDS[w.dataset]
        ),
        rooms=room_files,
        room_schema="workflow/schemas/room.schema.yaml",
        catalogue=catalogue_of,
        types="config/thor_types.csv",
        robot="config/robots/pr2.yaml",
        robot_schema="workflow/schemas/robot.schema.yaml",
    output:
        table="results/{dataset}/checks/certificates.csv",
    log:
        "results/logs/replay_certificates/{dataset}.log",
    benchmark:
        "results/benchmarks/replay_certificates/{dataset}.tsv"
    params:
        code=digest("replay_certificates"),
        rooms=folder_of,
        reach_m=config["putting_down"]["reach_m"],
        settings=flags("replay", "settling"),
    shell:
        r"""
        python workflow/scripts/replay_certificates.py \
            --dataset {wildcards.dataset:q} \
            --certificates {input.certificates:q} \
            --rooms {params.rooms:q} \
            --schema {input.room_schema:q} \
            --catalogue {input.catalogue:q} \
            --types {input.types:q} \
            --robots config/robots \
            --robot-schema {input.robot_schema:q} \
            --table {output.table:q} \
            --reach-m {params.reach_m:q} \
            {params.settings:q} \
            2>{log:q}
        """


rule plan_scenarios:
    """Plan how the robot fetches the objects of every scenario and arranges them."""
    input:
        theta="results/rooms/theta/all",
        clouds=f"results/{SCENARIOS}/clouds/fold0",
        scenes=f"results/{SCENARIOS}/scenes/fold0",
        features=f"results/{SCENARIOS}/features/fold0",
        rooms=[f"resources/{SCENARIOS}/{scene}.yaml" for scene in SCENARIO_SCENES],
        catalogue="config/scenario_objects.csv",
        schemas=[
            f"workflow/schemas/{name}.schema.yaml"
            for name in ("room", "robot", "grasps")
        ],
        robot="config/robots/pr2.yaml",
        grasps="config/grasps.csv",
    output:
        plans=f"results/{SCENARIOS}/plans/fold0.parquet",
        tried=f"results/{SCENARIOS}/tried/fold0.parquet",
        certificates=directory(f"results/{SCENARIOS}/certificates/fold0"),
    log:
        "results/logs/plan_scenarios.log",
    benchmark:
        "results/benchmarks/plan_scenarios.tsv"
    params:
        code=digest("plan_scenarios"),
        seed=config["seed"],
        rooms=folder_of_scenarios,
        settings=flags(
            *("candidates", "sampling", "diagnostics", "arranging"),
            *("decision", "baselines"),
            within="settings.",
        ),
        planning=flags(
            *("offering", "robot_placing", "planning", "checking", "settling"),
            within="planning.",
        ),
    shell:
        r"""
        python workflow/scripts/plan_scenarios.py \
            --theta {input.theta:q} \
            --clouds {input.clouds:q} \
            --scenes {input.scenes:q} \
            --features {input.features:q} \
            --rooms {params.rooms:q} \
            --catalogue {input.catalogue:q} \
            --schemas workflow/schemas \
            --robot {input.robot:q} \
            --grasps {input.grasps:q} \
            --plans {output.plans:q} \
            --tried {output.tried:q} \
            --certificates {output.certificates:q} \
            --seed {params.seed:q} \
            {params.settings:q} \
            {params.planning:q} \
            2>{log:q}
        """


rule execute_scenario:
    """Carry out the plan of a scenario in simulation, with physics."""
    input:
        certificates=f"results/{SCENARIOS}/certificates/fold0",
        plans=f"results/{SCENARIOS}/plans/fold0.parquet",
        room=f"resources/{SCENARIOS}/{{scene}}.yaml",
        catalogue="config/scenario_objects.csv",
        schemas=[f"workflow/schemas/{name}.schema.yaml" for name in ("room", "robot")],
        robot="config/robots/pr2.yaml",
    output:
        film=f"results/{SCENARIOS}/executions/{{scene}}.npz",
        placed=f"results/{SCENARIOS}/placed/{{scene}}.parquet",
    log:
        "results/logs/execute_scenario/{scene}.log",
    benchmark:
        "results/benchmarks/execute_scenario/{scene}.tsv"
    params:
        code=digest("execute_scenario"),
        rooms=folder_of_scenarios,
        settings=flags("executing", "playback", "settling"),
    shell:
        r"""
        python workflow/scripts/execute_scenario.py \
            --scene {wildcards.scene:q} \
            --certificates {input.certificates:q} \
            --plans {input.plans:q} \
            --rooms {params.rooms:q} \
            --catalogue {input.catalogue:q} \
            --schemas workflow/schemas \
            --robot {input.robot:q} \
            --film {output.film:q} \
            --placed {output.placed:q} \
            {params.settings:q} \
            2>{log:q}
        """


rule tabulate_execution:
    """List where the objects of all scenarios came to rest."""
    input:
        placed=[
            f"results/{SCENARIOS}/placed/{scene}.parquet" for scene in SCENARIO_SCENES
        ],
    output:
        table=f"results/{SCENARIOS}/tables/execution.csv",
    log:
        "results/logs/tabulate_execution.log",
    benchmark:
        "results/benchmarks/tabulate_execution.tsv"
    params:
        code=digest("tabulate_execution"),
    shell:
        r"""
        python workflow/scripts/tabulate_execution.py \
            --placed {input.placed:q} \
            --table {output.table:q} \
            2>{log:q}
        """
