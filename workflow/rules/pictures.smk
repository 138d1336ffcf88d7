"""What a person looks at: recordings of the arranging, pictures of rooms and objects.

Nothing reads these files but the check that they exist.

OUTPUTS

    results/{dataset}/recordings/fold{fold}/{task}/dp/       {scene}.rrd
    results/rooms/pictures/                                  objects*, rooms*, arrangements*
    results/rooms/figures/figure4.png, figure5.png           people of an office
    results/rooms/recordings/figure4.rrd, figure5.rrd        the same to turn around
"""


rule record_scene:
    """Record how the objects of the scenes of a fold were arranged."""
    input:
        clouds="results/{dataset}/clouds/fold{fold}",
        scenes="results/{dataset}/scenes/fold{fold}",
        features="results/{dataset}/features/fold{fold}",
        arrangements="results/{dataset}/arrangements/{task}/fold{fold}.parquet",
        poses="results/{dataset}/poses/{task}/fold{fold}.parquet",
        densities="results/{dataset}/densities/{task}/fold{fold}",
        scores="results/{dataset}/scores/{task}/fold{fold}.parquet",
        traces="results/{dataset}/traces/{task}/fold{fold}.parquet",
        diagnostics="results/{dataset}/diagnostics/{task}/fold{fold}.parquet",
        explanations="results/{dataset}/explanations/{task}/fold{fold}.parquet",
    output:
        recordings=directory("results/{dataset}/recordings/fold{fold}/{task}/dp"),
    log:
        "results/logs/record_scene/{dataset}/{task}/fold{fold}.log",
    benchmark:
        "results/benchmarks/record_scene/{dataset}/{task}/fold{fold}.tsv"
    params:
        code=digest("record_scene"),
        method="dp",
        seed=config["seed"],
    shell:
        r"""
        python workflow/scripts/record_scene.py \
            --dataset {wildcards.dataset:q} \
            --fold {wildcards.fold:q} \
            --task {wildcards.task:q} \
            --method {params.method:q} \
            --clouds {input.clouds:q} \
            --scenes {input.scenes:q} \
            --features {input.features:q} \
            --arrangements {input.arrangements:q} \
            --poses {input.poses:q} \
            --densities {input.densities:q} \
            --scores {input.scores:q} \
            --traces {input.traces:q} \
            --diagnostics {input.diagnostics:q} \
            --explanations {input.explanations:q} \
            --recordings {output.recordings:q} \
            --seed {params.seed:q} \
            2>{log:q}
        """


rule picture_objects:
    """Draw every object of the catalogue, and all of them on one sheet."""
    input:
        catalogue="config/objects.csv",
    output:
        pictures=directory("results/rooms/pictures/objects"),
        sheet="results/rooms/pictures/objects.png",
    log:
        "results/logs/picture_objects.log",
    benchmark:
        "results/benchmarks/picture_objects.tsv"
    params:
        code=digest("picture_objects"),
    shell:
        r"""
        python workflow/scripts/picture_objects.py \
            --catalogue {input.catalogue:q} \
            --pictures {output.pictures:q} \
            --contact-sheet {output.sheet:q} \
            2>{log:q}
        """


rule picture_rooms:
    """Draw every room, bare and as every labeller arranged it."""
    input:
        rooms=room_files,
        room_schema="workflow/schemas/room.schema.yaml",
        catalogue=catalogue_of,
    output:
        rooms=directory("results/{dataset}/pictures/rooms"),
        arrangements=directory("results/{dataset}/pictures/arrangements"),
        sheet_rooms="results/{dataset}/pictures/rooms.png",
        sheet_arrangements="results/{dataset}/pictures/arrangements.png",
    log:
        "results/logs/picture_rooms/{dataset}.log",
    benchmark:
        "results/benchmarks/picture_rooms/{dataset}.tsv"
    params:
        code=digest("picture_rooms"),
        rooms=folder_of,
        scenes=scenes_of,
    shell:
        r"""
        python workflow/scripts/picture_rooms.py \
            --rooms {params.rooms:q} \
            --scenes {params.scenes:q} \
            --schema {input.room_schema:q} \
            --catalogue {input.catalogue:q} \
            --pictures results/{wildcards.dataset:q}/pictures \
            --sheet-rooms {output.sheet_rooms:q} \
            --sheet-arrangements {output.sheet_arrangements:q} \
            2>{log:q}
        """


rule picture_desk:
    """Draw one desk as object context and as human context arrange it."""
    input:
        joint="results/scans/joint/fold0.parquet",
        room=f"resources/scans/{DESK['scene']}.yaml",
        room_schema="workflow/schemas/room.schema.yaml",
        catalogue="config/objects.csv",
    output:
        figure="results/scans/figures/figure7.png",
    log:
        "results/logs/picture_desk.log",
    benchmark:
        "results/benchmarks/picture_desk.tsv"
    params:
        code=digest("picture_desk"),
        scene=DESK["scene"],
        desk=DESK["furniture"],
    shell:
        r"""
        python workflow/scripts/picture_desk.py \
            --dataset scans \
            --scene {params.scene:q} \
            --desk {params.desk:q} \
            --joint {input.joint:q} \
            --rooms resources/scans \
            --schema {input.room_schema:q} \
            --catalogue {input.catalogue:q} \
            --figure {output.figure:q} \
            2>{log:q}
        """


rule picture_people:
    """Draw the people imagined in an office, and how it is arranged by them."""
    input:
        room=f"resources/rooms/{OFFICE['scene']}.yaml",
        room_schema="workflow/schemas/room.schema.yaml",
        catalogue="config/objects.csv",
        scenes=of_office("results/rooms/scenes/fold{fold}"),
        features=of_office("results/rooms/features/fold{fold}"),
        poses=[
            of_office(f"results/rooms/poses/{t}/fold{{fold}}.parquet") for t in TASKS
        ],
        arrangements=of_office("results/rooms/arrangements/empty/fold{fold}.parquet"),
        densities=of_office("results/rooms/densities/filled/fold{fold}"),
    output:
        figure4="results/rooms/figures/figure4.png",
        figure5="results/rooms/figures/figure5.png",
        recording4="results/rooms/recordings/figure4.rrd",
        recording5="results/rooms/recordings/figure5.rrd",
    log:
        "results/logs/picture_people.log",
    benchmark:
        "results/benchmarks/picture_people.tsv"
    params:
        code=digest("picture_people"),
        scene=OFFICE["scene"],
        method="dp",
        category="monitor",
        seed=config["seed"],
    shell:
        r"""
        python workflow/scripts/picture_people.py \
            --dataset rooms \
            --method {params.method:q} \
            --category {params.category:q} \
            --room {input.room:q} \
            --schema {input.room_schema:q} \
            --catalogue {input.catalogue:q} \
            --scene {input.scenes}/{params.scene:q}.json \
            --features {input.features}/{params.scene:q}.npz \
            --poses-filled {input.poses[0]:q} \
            --poses-empty {input.poses[1]:q} \
            --arrangements {input.arrangements:q} \
            --densities {input.densities}/{params.scene:q}.npz \
            --figure4 {output.figure4:q} \
            --figure5 {output.figure5:q} \
            --recording4 {output.recording4:q} \
            --recording5 {output.recording5:q} \
            --seed {params.seed:q} \
            2>{log:q}
        """
