#!/usr/bin/env python3
"""Prints what okoshi's speed is to be, and what it is on this machine, as a table in Markdown:

    python3 benches/table.py [--profile PROFILE] > table.md

Runs the benchmarks of this folder, and measures CPU time (of all threads, and of the system for them) and peak memory of whole
processes. Times are ratios to something that is measured in the same run wherever there is something to compare with. Takes about ten
minutes after the build, on a machine that does nothing else. Exit status 1 if a line misses what is required.
"""

import argparse
import json
import os
import re
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
BENCHMARKS = ("build", "again", "lsp", "soft", "terrain", "motion", "film")
ROUNDS = 7


def built(profile):
    """The programs that cargo builds for the benchmarks, by name, and okoshi."""
    command = ["cargo", "bench", "--locked", "--no-run", "--profile", profile, "--message-format", "json"]
    for name in BENCHMARKS:
        command += ["--bench", name]
    lines = subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True).stdout.splitlines()
    programs = {}
    for line in lines:
        message = json.loads(line)
        if message.get("executable"):
            programs[message["target"]["name"]] = message["executable"]
    return programs


def used(command):
    """The CPU seconds and the peak memory in MiB of a process that must succeed."""
    process = subprocess.Popen([str(part) for part in command], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        sys.exit(f"{command} failed")
    return usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024


def in_turn(*commands, rounds=ROUNDS):
    """The median CPU seconds and the greatest memory of commands that run in turn."""
    runs = [[used(command) for command in commands] for _ in range(rounds)]
    columns = zip(*runs)
    return [(statistics.median(s for s, _ in column), max(m for _, m in column)) for column in map(list, columns)]


class Table:
    def __init__(self):
        self.missed = 0
        print("| what | required | measured | |")
        print("|---|---|---|---|")

    def row(self, what, limit, value, unit="×", at_least=False):
        is_met = value >= limit if at_least else value <= limit
        self.missed += not is_met
        bound = "at least" if at_least else "at most"
        number = f"{value:.2f}" if value < 10 else f"{value:.0f}"
        print(f"| {what} | {bound} {limit:g} {unit} | {number} {unit} | {'' if is_met else 'missed'} |", flush=True)


def numbers(output, pattern):
    """The numbers that a pattern finds in the output of a benchmark, which must have them."""
    found = re.search(pattern, output, re.MULTILINE)
    if not found:
        sys.exit(f"no {pattern!r} in:\n{output}")
    return [float(group) for group in found.groups()]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--profile", default="bench", help="the profile that cargo builds with (bench)")
    programs = built(parser.parse_args().profile)
    okoshi = programs["okoshi"]

    def output(name, *arguments):
        command = [programs[name], "--bench", *arguments]
        # Those that check their own limits say so by their status.
        return subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, text=True, check=False).stdout

    table = Table()
    with tempfile.TemporaryDirectory() as scratch:
        drawing, model, picture = (Path(scratch) / name for name in ("drawing.svg", "model.glb", "picture.png"))
        for parts, rounds in (("10000", ROUNDS), ("100000", 3)):
            text = subprocess.run([programs["build"], "--drawing", parts], check=True, stdout=subprocess.PIPE).stdout
            drawing.write_bytes(text)
            usvg = [programs["build"], "--usvg", drawing]
            (parse, _), (build, memory) = in_turn(usvg, [okoshi, "build", "-q", drawing, "-o", model], rounds=rounds)
            table.row(f"`build` of {int(parts):,} parts, CPU time to that of usvg's parse", 2, build / parse)
            if parts == "100000":
                table.row(f"`build` of {int(parts):,} parts, peak memory", 400, memory, "MiB")

        again = output("again", "10000")
        for what in ("keystroke in a string", "number in a tag"):
            [ratio] = numbers(again, rf"^ *10000  {what} .* (\S+) +\S+$")
            table.row(f"Compiling 10,000 parts anew after a {what}, to usvg's parse", 1.1, ratio)

        lsp = output("lsp", "1000")
        [ratio] = numbers(lsp, r"^1000 +keystroke .* (\S+) +\S+$")
        table.row("Language server, 1,000 parts: keystroke to diagnostics, 99th percentile, to usvg's parse", 2, ratio)
        for what in ("hover", "completion"):
            [median] = numbers(lsp, rf"^1000 +{what} +(\S+) ")
            table.row(f"Language server, 1,000 parts: {what}, median", 1, median, "ms")

        [milliseconds] = numbers(output("soft", "10000"), r"alone +\S+ \( *(\S+)\)")
        table.row("10,000 inflated shapes, each alone", 1500, milliseconds, "ms")

        terrain = output("terrain")
        for side in (2048, 4096):
            line = rf"^{side} × {side} tiles:.*: (\S+) × and .*\n +memory: .* (\S+) bytes a tile, (\S+) MiB"
            ratio, all_bytes, written = numbers(terrain, line)
            table.row(f"Terrain of {side}² tiles, times as fast as block-mesh on one thread", 5, ratio, at_least=True)
            beside = all_bytes - written * 2**20 / side**2
            table.row(f"Terrain of {side}² tiles, memory beside what is written", 16, beside, "bytes a tile")

        motion = output("motion")
        for frames in (10_000, 100_000):
            pattern = rf"^{frames} frames:(?:.*\n)+?  whole run: .*: (\S+) × as long"
            [ratio] = numbers(motion, pattern)
            table.row(f"`motion`, {frames:,} frames, to reading and computing positions", 2, ratio)

        film = [float(ms) for ms in re.findall(r"^motion/\S+: (\S+) ms", output("film"), re.MULTILINE)]
        table.row("A picture of a film, 300 × 300, CPU time, the slowest figure", 60, max(film), "ms")

        def example(name):
            return ROOT / "examples" / f"{name}.svg"

        [(build, _)] = in_turn([okoshi, "build", "-q", example("clockwork-dragon"), "-o", model])
        table.row("`build` of the clockwork dragon, CPU time", 50, build * 1e3, "ms")
        [(build, _), (both, _)] = in_turn(
            [okoshi, "build", "-q", example("lady"), "-o", model],
            [okoshi, "render", "-q", example("lady"), "-o", picture],
        )
        table.row("A still picture of the lady, 800 × 800, CPU time without building", 300, (both - build) * 1e3, "ms")
        [(start, _)] = in_turn([okoshi, "--version"], rounds=21)
        table.row("Start of the program, CPU time", 10, start * 1e3, "ms")
    sys.exit(1 if table.missed else 0)


if __name__ == "__main__":
    main()
