"""What a person looks at of the joint placement: one recording per scene and method.

Nothing reads these files.

OUTPUTS

    results/scans/recordings/fold{fold}/                     {method}/{scene}.rrd
"""


rule record_joint:
    """Record the scenes of a fold as each method arranges them together."""
    input:
        clouds=f"results/{SCANS}/clouds/fold{{fold}}",
        scenes=f"results/{SCANS}/scenes/fold{{fold}}",
        features=f"results/{SCANS}/features/fold{{fold}}",
        proposals=f"results/{SCANS}/proposals/fold{{fold}}",
        tuning="results/rooms/joint_tuning/all.json",
        joint=f"results/{SCANS}/joint/fold{{fold}}.parquet",
        checks=f"results/{SCANS}/checks/joint.csv",
    output:
        recordings=directory(f"results/{SCANS}/recordings/fold{{fold}}"),
    log:
        f"results/logs/record_joint/{SCANS}/fold{{fold}}.log",
    benchmark:
        f"results/benchmarks/record_joint/{SCANS}/fold{{fold}}.tsv"
    params:
        code=digest("record_joint"),
        dataset=SCANS,
        spacing_m=config["candidates"]["spacing_m"],
    shell:
        r"""
        python workflow/scripts/record_joint.py \
            --dataset {params.dataset:q} \
            --fold {wildcards.fold:q} \
            --clouds {input.clouds:q} \
            --scenes {input.scenes:q} \
            --features {input.features:q} \
            --proposals {input.proposals:q} \
            --tuning {input.tuning:q} \
            --joint {input.joint:q} \
            --checks {input.checks:q} \
            --recordings {output.recordings:q} \
            --spacing-m {params.spacing_m:q} \
            2>{log:q}
        """
