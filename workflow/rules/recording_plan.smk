"""What a person looks at of the robot's plans, and what other robot tools replay.

Nothing reads these files.

INPUTS

    results/{dataset}/plans/fold{fold}.parquet               what the robot does
    results/{dataset}/tried/fold{fold}.parquet               what it was asked
    results/{dataset}/certificates/fold{fold}/               its motions

OUTPUTS

    results/{dataset}/recordings/fold{fold}/plans/           {scene}.rrd
    results/{dataset}/joint_logs/fold{fold}/                 {scene}.mcap, ROS 2
    results/scenarios/recordings/, joint_logs/               as they were carried out
    results/scenarios/pictures/{scenario}.png                what the robot does
"""


wildcard_constraints:
    scenario="|".join(SCENARIO_SCENES),


rule record_plan:
    """Record and log how the robot fills the empty scenes of a fold."""
    input:
        clouds="results/{dataset}/clouds/fold{fold}",
        scenes="results/{dataset}/scenes/fold{fold}",
        plans="results/{dataset}/plans/fold{fold}.parquet",
        tried="results/{dataset}/tried/fold{fold}.parquet",
        certificates="results/{dataset}/certificates/fold{fold}",
        robot="config/robots/pr2.yaml",
        robot_schema="workflow/schemas/robot.schema.yaml",
    output:
        recordings=directory("results/{dataset}/recordings/fold{fold}/plans"),
        logs=directory("results/{dataset}/joint_logs/fold{fold}"),
    log:
        "results/logs/record_plan/{dataset}/fold{fold}.log",
    benchmark:
        "results/benchmarks/record_plan/{dataset}/fold{fold}.tsv"
    params:
        code=digest("record_plan"),
        task="empty",
        constraints="inside",
        playback=flags("playback"),
    shell:
        r"""
        python workflow/scripts/record_plan.py \
            --fold {wildcards.fold:q} \
            --task {params.task:q} \
            --constraints {params.constraints:q} \
            --clouds {input.clouds:q} \
            --scenes {input.scenes:q} \
            --plans {input.plans:q} \
            --tried {input.tried:q} \
            --certificates {input.certificates:q} \
            --robot {input.robot:q} \
            --robot-schema {input.robot_schema:q} \
            --recordings {output.recordings:q} \
            --logs {output.logs:q} \
            {params.playback:q} \
            2>{log:q}
        """


rule record_scenarios:
    """Record and log the scenarios of Section 4.3 as they were carried out."""
    input:
        clouds="results/scenarios/clouds/fold0",
        scenes="results/scenarios/scenes/fold0",
        plans="results/scenarios/plans/fold0.parquet",
        tried="results/scenarios/tried/fold0.parquet",
        certificates="results/scenarios/certificates/fold0",
        films=expand("results/scenarios/executions/{scene}.npz", scene=SCENARIO_SCENES),
        robot="config/robots/pr2.yaml",
        robot_schema="workflow/schemas/robot.schema.yaml",
    output:
        recordings=directory("results/scenarios/recordings"),
        logs=directory("results/scenarios/joint_logs"),
    log:
        "results/logs/record_scenarios.log",
    benchmark:
        "results/benchmarks/record_scenarios.tsv"
    params:
        code=digest("record_plan"),
        films=films_of_scenarios,
        playback=flags("playback"),
    shell:
        r"""
        python workflow/scripts/record_plan.py \
            --fold 0 \
            --task empty \
            --constraints inside \
            --clouds {input.clouds:q} \
            --scenes {input.scenes:q} \
            --plans {input.plans:q} \
            --tried {input.tried:q} \
            --certificates {input.certificates:q} \
            --films {params.films:q} \
            --robot {input.robot:q} \
            --robot-schema {input.robot_schema:q} \
            --recordings {output.recordings:q} \
            --logs {output.logs:q} \
            {params.playback:q} \
            2>{log:q}
        """


rule picture_strip:
    """Draw a strip of pictures of a scenario as it was carried out."""
    input:
        film="results/scenarios/executions/{scenario}.npz",
        rooms="resources/scenarios/{scenario}.yaml",
        schema="workflow/schemas/room.schema.yaml",
        catalogue="config/scenario_objects.csv",
        robot="config/robots/pr2.yaml",
        robot_schema="workflow/schemas/robot.schema.yaml",
    output:
        picture="results/scenarios/pictures/{scenario}.png",
    log:
        "results/logs/picture_strip/{scenario}.log",
    benchmark:
        "results/benchmarks/picture_strip/{scenario}.tsv"
    params:
        code=digest("picture_strip"),
        rooms=folder_of_scenarios,
    shell:
        r"""
        python workflow/scripts/picture_strip.py \
            --scene {wildcards.scenario:q} \
            --film {input.film:q} \
            --rooms {params.rooms:q} \
            --schema {input.schema:q} \
            --catalogue {input.catalogue:q} \
            --robot {input.robot:q} \
            --robot-schema {input.robot_schema:q} \
            --picture {output.picture:q} \
            2>{log:q}
        """
