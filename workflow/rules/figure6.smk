"""Figure 6 of the paper: errors of every method in filled and empty scenes.

INPUTS

    results/{dataset}/scores/{task}/fold{fold}.parquet

OUTPUTS

    results/{dataset}/tables/figure6.csv, figure6.md
    results/{dataset}/figures/figure6_{task}.png, figure6_{task}.svg
"""


rule tabulate_figure6:
    """Average the errors of all folds by method, task and category."""
    input:
        scores=of_every_fold("results/{dataset}/scores/{task}/fold{fold}.parquet"),
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
