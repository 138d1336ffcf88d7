"""Checks of the data and of what was computed, and the record of the run.

OUTPUTS

    results/{dataset}/checks/areas.csv           placing areas found, by furniture kind
    results/{dataset}/checks/arrangements.csv    whether what labellers placed stays put
    results/thor/checks/support.csv              whether what designers placed is supported
    results/thor/checks/left_out.csv             what became of each type of thing
    results/{dataset}/checks/passed.txt          every claim about the artifacts holds
    results/run.json                             what was run, on what, and how long
"""


rule check_areas:
    """Compare the placing areas found in the clouds with the true ones."""
    input:
        rooms=room_files,
        room_schema="workflow/schemas/room.schema.yaml",
        catalogue="config/objects.csv",
        types="config/thor_types.csv",
        scenes=of_every_fold("results/{dataset}/scenes/fold{fold}"),
    output:
        table="results/{dataset}/checks/areas.csv",
    log:
        "results/logs/check_areas/{dataset}.log",
    benchmark:
        "results/benchmarks/check_areas/{dataset}.tsv"
    params:
        code=digest("check_areas"),
        rooms=folder_of,
        min_clearance_m=config["areas"]["min_clearance_m"],
        max_height_m=config["areas"]["max_height_m"],
        tolerance_m=config["coverage"]["tolerance_m"],
    shell:
        r"""
        python workflow/scripts/check_areas.py \
            --dataset {wildcards.dataset:q} \
            --rooms {params.rooms:q} \
            --schema {input.room_schema:q} \
            --catalogue {input.catalogue:q} \
            --types {input.types:q} \
            --scenes {input.scenes:q} \
            --min-clearance-m {params.min_clearance_m:q} \
            --max-height-m {params.max_height_m:q} \
            --tolerance-m {params.tolerance_m:q} \
            --table {output.table:q} \
            2>{log:q}
        """


rule settle_arrangements:
    """Let physics settle every labelled arrangement and measure what moved."""
    input:
        rooms=room_files,
        room_schema="workflow/schemas/room.schema.yaml",
        catalogue="config/objects.csv",
    output:
        checks="results/{dataset}/checks/arrangements.csv",
    log:
        "results/logs/settle_arrangements/{dataset}.log",
    benchmark:
        "results/benchmarks/settle_arrangements/{dataset}.tsv"
    params:
        code=digest("settle_arrangements"),
        rooms=folder_of,
        scenes=scenes_of,
        settling=flags("settling"),
    shell:
        r"""
        python workflow/scripts/settle_arrangements.py \
            --dataset {wildcards.dataset:q} \
            --rooms {params.rooms:q} \
            --scenes {params.scenes:q} \
            --schema {input.room_schema:q} \
            --catalogue {input.catalogue:q} \
            --checks {output.checks:q} \
            {params.settling:q} \
            2>{log:q}
        """


rule check_support:
    """Measure how well the shapes given to designers' rooms carry their objects."""
    input:
        scenes=every("results/thor/scenes/fold{fold}", "thor"),
        types="config/thor_types.csv",
    output:
        support="results/thor/checks/support.csv",
        left_out="results/thor/checks/left_out.csv",
    log:
        "results/logs/check_support.log",
    benchmark:
        "results/benchmarks/check_support.tsv"
    params:
        code=digest("check_support"),
    shell:
        r"""
        python workflow/scripts/check_support.py \
            --scenes {input.scenes:q} \
            --types {input.types:q} \
            --support {output.support:q} \
            --left-out {output.left_out:q} \
            2>{log:q}
        """


rule check_artifacts:
    """Check the artifacts of a data set; write the claims that hold."""
    input:
        scenes_sheet="config/scenes.csv",
        checks=checks_of,
        scores=of_every_fold("results/{dataset}/scores/{task}/fold{fold}.parquet"),
        theta=of_every_fold("results/{dataset}/theta/fold{fold}"),
        table="results/{dataset}/tables/figure6.csv",
        recordings=of_every_fold("results/{dataset}/recordings/fold{fold}/{task}/dp"),
    output:
        passed="results/{dataset}/checks/passed.txt",
    log:
        "results/logs/check_artifacts/{dataset}.log",
    benchmark:
        "results/benchmarks/check_artifacts/{dataset}.tsv"
    params:
        code=digest("check_artifacts"),
    shell:
        r"""
        python workflow/scripts/check_artifacts.py \
            --dataset {wildcards.dataset:q} \
            --scenes-sheet {input.scenes_sheet:q} \
            --results results/{wildcards.dataset:q} \
            --passed {output.passed:q} \
            2>{log:q}
        """


rule describe_run:
    """Write down what was run, with which versions, on what machine and how long."""
    input:
        passed=expand("results/{dataset}/checks/passed.txt", dataset=STUDIED),
    output:
        described="results/run.json",
    log:
        "results/logs/describe_run.log",
    params:
        code=digest("describe_run"),
        config=json.dumps(config, sort_keys=True),
    shell:
        r"""
        python workflow/scripts/describe_run.py \
            --config {params.config:q} \
            --benchmarks results/benchmarks \
            --described {output.described:q} \
            2>{log:q}
        """
