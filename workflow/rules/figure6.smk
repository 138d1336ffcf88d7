"""Figure 6 of the paper: errors of every method in filled and empty scenes.

And what is needed to trust it: claims, diagnostics, coverage and sensitivity.

INPUTS

    results/{dataset}/scores/{task}/fold{fold}.parquet
    results/{dataset}/diagnostics/{task}/fold{fold}.parquet
    results/{dataset}/tuning/fold{fold}.json

OUTPUTS

    results/{dataset}/tables/figure6.csv, figure6.md         errors by method, category
    results/{dataset}/tables/claims.csv, claims.md           which method beats which
    results/{dataset}/tables/diagnostics.csv, diagnostics.md do the chains agree
    results/{dataset}/tables/coverage.csv, coverage.md       are the regions right
    results/{dataset}/tables/sensitivity.csv, sensitivity.md does a setting matter
    results/{dataset}/figures/figure6_{task}.png, figure6_{task}.svg
    results/{dataset}/figures/coverage.png, coverage.svg
"""


rule tabulate_figure6:
    """Average the errors of all folds by method, task and category."""
    input:
        scores=of_every_fold("results/{dataset}/scores/{task}/fold{fold}.parquet"),
        diagnostics=of_every_fold(
            "results/{dataset}/diagnostics/{task}/fold{fold}.parquet"
        ),
        paper="config/paper.csv",
    output:
        table="results/{dataset}/tables/figure6.csv",
        markdown="results/{dataset}/tables/figure6.md",
    log:
        "results/logs/tabulate_figure6/{dataset}.log",
    benchmark:
        "results/benchmarks/tabulate_figure6/{dataset}.tsv"
    params:
        code=digest("tabulate_figure6"),
    shell:
        r"""
        python workflow/scripts/tabulate_figure6.py \
            --scores {input.scores:q} \
            --diagnostics {input.diagnostics:q} \
            --paper {input.paper:q} \
            --table {output.table:q} \
            --markdown {output.markdown:q} \
            2>{log:q}
        """


rule plot_figure6:
    """Draw the errors of every method and category in one task."""
    input:
        table="results/{dataset}/tables/figure6.csv",
    output:
        png="results/{dataset}/figures/figure6_{task}.png",
        svg="results/{dataset}/figures/figure6_{task}.svg",
    log:
        "results/logs/plot_figure6/{dataset}/{task}.log",
    benchmark:
        "results/benchmarks/plot_figure6/{dataset}/{task}.tsv"
    params:
        code=digest("plot_figure6"),
    shell:
        r"""
        python workflow/scripts/plot_figure6.py \
            --task {wildcards.task:q} \
            --table {input.table:q} \
            --png {output.png:q} \
            --svg {output.svg:q} \
            2>{log:q}
        """


rule compare_methods:
    """Test every claim that one method beats another."""
    input:
        scores=of_every_fold("results/{dataset}/scores/{task}/fold{fold}.parquet"),
    output:
        table="results/{dataset}/tables/claims.csv",
        markdown="results/{dataset}/tables/claims.md",
    log:
        "results/logs/compare_methods/{dataset}.log",
    benchmark:
        "results/benchmarks/compare_methods/{dataset}.tsv"
    params:
        code=digest("compare_methods"),
        seed=config["seed"],
    shell:
        r"""
        python workflow/scripts/compare_methods.py \
            --scores {input.scores:q} \
            --seed {params.seed:q} \
            --table {output.table:q} \
            --markdown {output.markdown:q} \
            2>{log:q}
        """


rule tabulate_diagnostics:
    """Tell in how many questions the chains agree."""
    input:
        questions=of_every_fold(
            "results/{dataset}/diagnostics/{task}/fold{fold}.parquet"
        ),
    output:
        table="results/{dataset}/tables/diagnostics.csv",
        markdown="results/{dataset}/tables/diagnostics.md",
    log:
        "results/logs/tabulate_diagnostics/{dataset}.log",
    benchmark:
        "results/benchmarks/tabulate_diagnostics/{dataset}.tsv"
    params:
        code=digest("tabulate_diagnostics"),
        diagnostics=flags("diagnostics"),
    shell:
        r"""
        python workflow/scripts/tabulate_diagnostics.py \
            --dataset {wildcards.dataset:q} \
            --questions {input.questions:q} \
            --table {output.table:q} \
            --markdown {output.markdown:q} \
            {params.diagnostics:q} \
            2>{log:q}
        """


rule tabulate_coverage:
    """Measure how often regions hold the labelled object."""
    input:
        scores=of_every_fold("results/{dataset}/scores/{task}/fold{fold}.parquet"),
        tuning=of_every_fold("results/{dataset}/tuning/fold{fold}.json"),
        arrangements=of_every_fold(
            "results/{dataset}/arrangements/{task}/fold{fold}.parquet"
        ),
        scenes_sheet="config/scenes.csv",
    output:
        table="results/{dataset}/tables/coverage.csv",
        markdown="results/{dataset}/tables/coverage.md",
    log:
        "results/logs/tabulate_coverage/{dataset}.log",
    benchmark:
        "results/benchmarks/tabulate_coverage/{dataset}.tsv"
    params:
        code=digest("tabulate_coverage"),
    shell:
        r"""
        python workflow/scripts/tabulate_coverage.py \
            --scores {input.scores:q} \
            --tuning {input.tuning:q} \
            --arrangements {input.arrangements:q} \
            --scenes-sheet {input.scenes_sheet:q} \
            --table {output.table:q} \
            --markdown {output.markdown:q} \
            2>{log:q}
        """


rule plot_coverage:
    """Draw measured against stated probability of the regions."""
    input:
        table="results/{dataset}/tables/coverage.csv",
    output:
        png="results/{dataset}/figures/coverage.png",
        svg="results/{dataset}/figures/coverage.svg",
    log:
        "results/logs/plot_coverage/{dataset}.log",
    benchmark:
        "results/benchmarks/plot_coverage/{dataset}.tsv"
    params:
        code=digest("plot_coverage"),
    shell:
        r"""
        python workflow/scripts/plot_coverage.py \
            --table {input.table:q} \
            --png {output.png:q} \
            --svg {output.svg:q} \
            2>{log:q}
        """


rule vary_settings:
    """Arrange the scenes of a fold with one setting changed at a time."""
    input:
        theta="results/{dataset}/theta/fold{fold}",
        scenes="results/{dataset}/scenes/fold{fold}",
        features="results/{dataset}/features/fold{fold}",
    output:
        scores="results/{dataset}/sensitivity/fold{fold}.parquet",
    log:
        "results/logs/vary_settings/{dataset}/fold{fold}.log",
    benchmark:
        "results/benchmarks/vary_settings/{dataset}/fold{fold}.tsv"
    params:
        code=digest("vary_settings"),
        seed=config["seed"],
        settings=flags(*ANSWERING, within="settings."),
        sensitivity=flags("sensitivity", "scoring"),
    shell:
        r"""
        python workflow/scripts/vary_settings.py \
            --dataset {wildcards.dataset:q} \
            --theta {input.theta:q} \
            --scenes {input.scenes:q} \
            --features {input.features:q} \
            --scores {output.scores:q} \
            --seed {params.seed:q} \
            {params.settings:q} \
            {params.sensitivity:q} \
            2>{log:q}
        """


rule tabulate_sensitivity:
    """Tell how much the averages depend on each setting."""
    input:
        scores=of_every_fold("results/{dataset}/sensitivity/fold{fold}.parquet"),
    output:
        table="results/{dataset}/tables/sensitivity.csv",
        markdown="results/{dataset}/tables/sensitivity.md",
    log:
        "results/logs/tabulate_sensitivity/{dataset}.log",
    benchmark:
        "results/benchmarks/tabulate_sensitivity/{dataset}.tsv"
    params:
        code=digest("tabulate_sensitivity"),
        seed=config["seed"],
    shell:
        r"""
        python workflow/scripts/tabulate_sensitivity.py \
            --scores {input.scores:q} \
            --seed {params.seed:q} \
            --table {output.table:q} \
            --markdown {output.markdown:q} \
            2>{log:q}
        """
