"""Shards under HyperQueue: a local cluster of its Python package, which of them a task runs said by HQ_TASK_ID
alone, merged and compared with one unsharded run.

Usage: python hyperqueue_shards.py FOGBENCH    (needs the package hyperqueue)
"""

import filecmp
import os
import subprocess
import sys
import tempfile
from pathlib import Path

from hyperqueue import Job
from hyperqueue.cluster import LocalCluster, WorkerConfig

SHARDS = 4
SCENARIO = """schema = 1
name = "many"
duration_s = 2.0
warm_up_s = 0.5
fidelity = "rate"
repeats = 10
"""
# Each task says which number it was given.
TASK = 'echo "$HQ_TASK_ID" > "task-$HQ_TASK_ID"; exec "$@"'


def differences(one: Path, other: Path) -> list[str]:
    """Paths below which two folders differ, `.fogbench` left out."""
    compared = filecmp.dircmp(one, other, ignore=[".fogbench"])
    _, different, unread = filecmp.cmpfiles(one, other, compared.common_files, shallow=False)
    found = compared.left_only + compared.right_only + different + unread
    for name in compared.common_dirs:
        found += [f"{name}/{path}" for path in differences(one / name, other / name)]
    return found


def main(fogbench: str, folder: Path) -> None:
    def run(*arguments: str) -> None:
        subprocess.run([fogbench, *arguments], cwd=folder, check=True)

    (folder / "many.toml").write_text(SCENARIO)
    run("run", "many.toml", "-q", "-o", "whole")
    run("plan", "many.toml", "-o", "suite.plan", "--shards", str(SHARDS))
    with LocalCluster() as cluster:
        cluster.start_worker(WorkerConfig(cores=2))
        client = cluster.client()
        # Tasks of the package may count from 0, those of `hq submit --array 1-4` count from 1.
        first = first_task(client, folder)
        command = [fogbench, "run", "--plan", "suite.plan", "-o", "shards"]
        command += ["--shard-offset", str(1 - first)]
        job = Job(default_workdir=folder)
        for _ in range(SHARDS):
            job.program(["sh", "-c", TASK, "sh", *command])
        client.wait_for_jobs([client.submit(job)])
    told = sorted(int(path.name.removeprefix("task-")) for path in folder.glob("task-*"))
    assert told == list(range(first, first + SHARDS)), told
    run("status", "shards")
    run("merge", "shards", "-q", "-o", "merged")
    found = differences(folder / "whole", folder / "merged")
    assert not found, found
    print(f"{SHARDS} shards under HyperQueue: the bytes of one run")


def first_task(client, folder: Path) -> int:
    """The number of the first task of a job, as the environment of the task says it."""
    probe = Job(default_workdir=folder)
    probe.program(["sh", "-c", 'echo "$HQ_TASK_ID" > first'])
    client.wait_for_jobs([client.submit(probe)])
    return int((folder / "first").read_text())


if __name__ == "__main__":
    # The variables of another scheduler would contradict.
    for name in ("SLURM_ARRAY_TASK_ID", "JOB_COMPLETION_INDEX", "PBS_ARRAY_INDEX"):
        os.environ.pop(name, None)
    with tempfile.TemporaryDirectory() as scratch:
        main(str(Path(sys.argv[1]).resolve()), Path(scratch))
