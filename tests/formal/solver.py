"""Runs yosys and the solver: many designs in one run of yosys, whose start takes longer than they do."""

import os
import re
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path

YOSYS, SMTBMC = (os.environ.get(name, usual) for name, usual in
                 [("YOSYS", "yosys"), ("SMTBMC", "yosys-smtbmc")])


@dataclass
class Trial:
    """A design and a question about it."""

    name: str
    sources: dict  # names of files, and their text
    script: list  # of yosys, up to the design whose properties are asked for
    question: list  # arguments of yosys-smtbmc
    solver: str = "yices"
    declarations: str = ""  # for the solver, in front of the design
    folder: Path = field(default=None)


@dataclass(frozen=True)
class Answer:
    passed: bool
    text: str
    seconds: float

    def broken(self, properties):
        """Those of the named properties that the solver found broken."""
        failed = re.findall(r"Assert failed in \S+: (\S+)", self.text)
        return {name for name in properties if any(name == text.split(".")[-1] for text in failed)}


def ask(scratch, trials):
    """The answer to each of the trials, in their order."""
    lines = []
    for number, trial in enumerate(trials):
        trial.folder = scratch / str(number)
        trial.folder.mkdir(parents=True)
        for name, text in trial.sources.items():
            (trial.folder / name).write_text(text)
        lines += [line.replace("@/", f"{number}/") for line in trial.script]
        lines += [f"write_smt2 -wires {number}/design.smt2", "design -reset", "design -reset-vlog"]
    (scratch / "designs.ys").write_text("\n".join(lines) + "\n")
    run = subprocess.run([YOSYS, "-q", "designs.ys"], cwd=scratch, capture_output=True, text=True, check=False)
    # What a wire connected by name decides would be lost with its driver.
    if run.returncode or "has no driver" in run.stderr:
        sys.exit(f"yosys failed on {scratch}\n{run.stdout}{run.stderr}")
    with ThreadPoolExecutor(os.cpu_count()) as workers:
        return list(workers.map(answer, trials))


def prove(part, scratch, proofs, others):
    """The answers to the other trials; a proof that is none ends the run."""
    answers = ask(scratch, proofs + others)
    for question, answer in zip(proofs, answers):
        if not answer.passed:
            sys.exit(f"{part}, {question.name}: not passed\n{answer.text}")
    return answers[len(proofs):]


def all_broken(properties, broken):
    """Ends the run where a property holds under every planted bug."""
    if properties - broken:
        sys.exit(f"no bug breaks {sorted(properties - broken)}")


def break_each(planted, answers, properties):
    """Ends the run where a planted bug breaks none of the properties, or a property is broken by none."""
    broken = set()
    for question, answer in zip(planted, answers):
        found = answer.broken(properties)
        if not found:
            sys.exit(f"{question.name}: planted, and broke nothing\n{answer.text}")
        broken |= found
    all_broken(properties, broken)


def answer(trial):
    """What the solver says of a trial; that it is missing or fails ends the run."""
    design = trial.folder / "design.smt2"
    design.write_text(trial.declarations + design.read_text())
    start = time.monotonic()
    run = subprocess.run([SMTBMC, "-s", trial.solver, *trial.question, "design.smt2"], cwd=trial.folder,
                         capture_output=True, text=True, check=False)
    text = run.stdout + run.stderr
    if "Status: PASSED" not in text and "Status: FAILED" not in text:
        sys.exit(f"{trial.name}: no answer\n{text}")
    return Answer(run.returncode == 0, text, time.monotonic() - start)


def plant(name, text, right, wrong):
    """The text with a bug in the only place where it can be."""
    if text.count(right) != 1:
        sys.exit(f"not once in {name}: {right}")
    return text.replace(right, wrong)
