"""Table 2 of the paper: five point-cloud scenes, measured and, with raters, rated.

`./run snakemake -j2 rate` makes the page on which people rate; what they saved goes into
`config/ratings/` and gives Table 2 a second block.

INPUTS

    results/scans/joint/fold0.parquet                        where everything was put
    config/correct_places.csv, supports.csv                  the judge
    config/ratings/*.csv                                     raters, if there are any

OUTPUTS

    results/scans/scores/table2.csv                          error and verdict by object
    results/scans/tables/table2.csv, table2.md
    results/scans/tables/table2_rated.csv                    without rows if nobody rated
    results/scans/rating/rate.html, key.csv                  only on demand
"""


rule tabulate_table2:
    """Tabulate correct places and scores beside the numbers of the paper."""
    input:
        joint="results/scans/joint/fold0.parquet",
        rooms=SCAN_FILES,
        room_schema="workflow/schemas/room.schema.yaml",
        catalogue="config/objects.csv",
        scenes="results/scans/scenes/fold0",
        features="results/scans/features/fold0",
        correct_places="config/correct_places.csv",
        supports="config/supports.csv",
        paper="config/paper.csv",
        ratings=sorted(str(path) for path in Path("config/ratings").glob("*.csv")),
        ratings_schema="workflow/schemas/ratings.schema.yaml",
    output:
        scores="results/scans/scores/table2.csv",
        table="results/scans/tables/table2.csv",
        rated="results/scans/tables/table2_rated.csv",
        markdown="results/scans/tables/table2.md",
    log:
        "results/logs/tabulate_table2.log",
    benchmark:
        "results/benchmarks/tabulate_table2.tsv"
    params:
        code=digest("tabulate_table2"),
        seed=config["seed"],
        min_overlap=config["candidates"]["min_overlap"],
        ratings=lambda wildcards, input: (
            ["--ratings", *input.ratings] if input.ratings else []
        ),
    shell:
        r"""
        python workflow/scripts/tabulate_table2.py \
            --joint {input.joint:q} \
            --rooms resources/scans \
            --schema {input.room_schema:q} \
            --catalogue {input.catalogue:q} \
            --scenes {input.scenes:q} \
            --features {input.features:q} \
            --correct-places {input.correct_places:q} \
            --supports {input.supports:q} \
            --paper {input.paper:q} \
            --ratings-schema {input.ratings_schema:q} \
            --scores {output.scores:q} \
            --table {output.table:q} \
            --rated {output.rated:q} \
            --markdown {output.markdown:q} \
            --seed {params.seed:q} \
            --min-overlap {params.min_overlap:q} \
            {params.ratings:q} \
            2>{log:q}
        """


rule rate:
    """Make the page on which people rate the arrangements, and the key to it."""
    input:
        joint="results/scans/joint/fold0.parquet",
        rooms=SCAN_FILES,
        room_schema="workflow/schemas/room.schema.yaml",
        catalogue="config/objects.csv",
        template="src/placing/rating/page.html",
    output:
        page="results/scans/rating/rate.html",
        key="results/scans/rating/key.csv",
    log:
        "results/logs/rate.log",
    benchmark:
        "results/benchmarks/rate.tsv"
    params:
        code=digest("rate"),
        scenes=SCAN_SCENES,
        seed=config["seed"],
    shell:
        r"""
        python workflow/scripts/rate.py \
            --joint {input.joint:q} \
            --rooms resources/scans \
            --scenes {params.scenes:q} \
            --schema {input.room_schema:q} \
            --catalogue {input.catalogue:q} \
            --template {input.template:q} \
            --page {output.page:q} \
            --key {output.key:q} \
            --seed {params.seed:q} \
            2>{log:q}
        """
