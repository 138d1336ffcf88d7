"""From sources of rooms to what every later stage sees: clouds and placing areas.

INPUTS

    resources/rooms/{scene}.yaml                     rooms of the data set `rooms`
    resources/scans/{scene}.yaml                     rooms that a depth camera sees
    the wheel of procthor                            rooms of the data set `thor`
    config/objects.csv                               the objects

OUTPUTS

    results/{dataset}/clouds/fold{fold}/             {scene}.ply, {scene}.json
    results/{dataset}/scenes/fold{fold}/             {scene}.json
    results/{dataset}/features/fold{fold}/           {scene}.npz
"""


rule preprocess_cloud:
    """Scan the scenes of a fold and clean their clouds."""
    input:
        rooms=room_files,
        room_schema="workflow/schemas/room.schema.yaml",
        catalogue=catalogue_of,
        types="config/thor_types.csv",
    output:
        clouds=directory("results/{dataset}/clouds/fold{fold}"),
    log:
        "results/logs/preprocess_cloud/{dataset}/fold{fold}.log",
    benchmark:
        "results/benchmarks/preprocess_cloud/{dataset}/fold{fold}.tsv"
    params:
        code=digest("preprocess_cloud"),
        scenes=scenes_of,
        seed=config["seed"],
        rooms=folder_of,
        spacing_m=config["scan"]["spacing_m"],
        settings=flags("camera", "cloud"),
    shell:
        r"""
        python workflow/scripts/preprocess_cloud.py \
            --dataset {wildcards.dataset:q} \
            --scenes {params.scenes:q} \
            --rooms {params.rooms:q} \
            --schema {input.room_schema:q} \
            --catalogue {input.catalogue:q} \
            --types {input.types:q} \
            --clouds {output.clouds:q} \
            --seed {params.seed:q} \
            --spacing-m {params.spacing_m:q} \
            {params.settings:q} \
            2>{log:q}
        """


rule find_areas:
    """Find the placing areas in the clouds of a fold."""
    input:
        clouds="results/{dataset}/clouds/fold{fold}",
    output:
        scenes=directory("results/{dataset}/scenes/fold{fold}"),
    log:
        "results/logs/find_areas/{dataset}/fold{fold}.log",
    benchmark:
        "results/benchmarks/find_areas/{dataset}/fold{fold}.tsv"
    params:
        code=digest("find_areas"),
        areas=flags("areas"),
    shell:
        r"""
        python workflow/scripts/find_areas.py \
            --clouds {input.clouds:q} \
            --scenes {output.scenes:q} \
            {params.areas:q} \
            2>{log:q}
        """


rule extract_features:
    """List where the people and the objects of a fold may be, with features."""
    input:
        clouds="results/{dataset}/clouds/fold{fold}",
        scenes="results/{dataset}/scenes/fold{fold}",
    output:
        features=directory("results/{dataset}/features/fold{fold}"),
    log:
        "results/logs/extract_features/{dataset}/fold{fold}.log",
    benchmark:
        "results/benchmarks/extract_features/{dataset}/fold{fold}.tsv"
    params:
        code=digest("extract_features"),
        settings=flags("candidates", "poses"),
    shell:
        r"""
        python workflow/scripts/extract_features.py \
            --clouds {input.clouds:q} \
            --scenes {input.scenes:q} \
            --features {output.features:q} \
            {params.settings:q} \
            2>{log:q}
        """
