#!/usr/bin/env python3
"""mutate.py [--count N] [--seed S] [--only REGEX] [--list] [--work DIR]

Do the tests notice when a kernel is wrong? Copies the tree, changes one line of a kernel, builds
what that touches, runs the determinism table and the unit tests, and stops at the first failure.
Prints what was caught and what was not; exit code 1 when less than 95 % was caught.

A mutant that does not compile, or from which the compiler makes the very same machine code, is no
mutant: the next one is drawn. Those in equivalent.txt are left out for the reason given there.
"""

import argparse
import collections
import os
import platform
import re
import resource
import shutil
import subprocess
import sys
import threading
import time
from pathlib import Path

import mutators

ROOT = Path(__file__).resolve().parents[2]
GOAL = 0.95
# Kernels alone are built in another way: quickly, and for one SIMD target instead of four. What the
# compiler can prove to reach beyond an array does not pass any preset, and does not build here.
KERNEL_FLAGS = (
    "-O1;-DHWY_COMPILE_ONLY_STATIC;-march=x86-64-v3;-maes;-mpclmul"
    ";-Werror=aggressive-loop-optimizations;-Werror=array-bounds"
)
SUITES = {"rasterizer": "unit_rasterizer", "postfx": "unit_postfx"}
QUICK_S = 0.15  # unit tests that take longer come last
SPARE_S = 20  # a test that takes this much more than three times its time has failed
MEMORY = 4 << 30  # bytes that a test may ask for


class Bench:
    """A copy of the tree, built once, that goes back to that state after each mutant."""

    def __init__(self, work):
        # The build lies in the tree as it does in the repository, for the sake of compiler caches.
        self.tree, self.build, self.saved = work / "tree", work / "tree/build/mutant", work / "saved"
        self.copy_tree()
        self.run(["cmake", "-S", self.tree, "-B", self.build, "-G", "Ninja"]
                 + ["-DCMAKE_BUILD_TYPE=Release", f"-DSTILL_KERNEL_FLAGS={KERNEL_FLAGS}"]
                 + ["-DSTILL_TESTS=ON", "-DSTILL_VIEWER=OFF", "-DSTILL_SUBBUILDS=OFF"])  # fmt: skip
        self.run(["ninja", "-C", self.build, "-j1", "determinism", *SUITES.values()])
        shutil.rmtree(self.saved, ignore_errors=True)
        shutil.copytree(self.build, self.saved, symlinks=True)
        self.state = dict(self.files(self.build))
        self.batches = {suite: self.measured(suite) for suite in SUITES.values()}
        seconds, passed, output = self.timed([self.determinism(), "--few"], 600)
        if not passed:
            sys.exit(f"The tests fail without any mutant:\n{output}")
        self.determinism_s = seconds

    @staticmethod
    def run(command):
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"{' '.join(map(str, command))}\n{done.stdout[-4000:]}{done.stderr[-4000:]}")

    def copy_tree(self):
        """Files that have not changed keep their time, so that a second run builds little."""
        listed = subprocess.run(["git", "ls-files", "-co", "--exclude-standard"], cwd=ROOT,
                                capture_output=True, text=True, check=True)  # fmt: skip
        wanted = {name for name in listed.stdout.splitlines() if (ROOT / name).is_file()}
        for name in wanted:
            source, copy = ROOT / name, self.tree / name
            if not copy.exists() or copy.read_bytes() != source.read_bytes():
                copy.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(source, copy)
        for name, _ in list(self.files(self.tree)):
            if name not in wanted and not name.startswith("build/"):
                (self.tree / name).unlink()

    @staticmethod
    def files(folder):
        for at, _, names in os.walk(folder):
            for name in names:
                info = os.stat(os.path.join(at, name))
                yield os.path.relpath(os.path.join(at, name), folder), (info.st_mtime_ns, info.st_size)

    def changed(self):
        return [name for name, state in self.files(self.build) if self.state.get(name) != state]

    def restore(self, source, text, times_ns):
        """The source with its old time and every file that the mutant's build made anew."""
        source.write_text(text)
        os.utime(source, ns=times_ns)
        for name in self.changed():
            if name in self.state:
                shutil.copy2(self.saved / name, self.build / name)
            else:
                (self.build / name).unlink()

    def determinism(self):
        return self.build / "tests/determinism/determinism"

    @staticmethod
    def timed(command, limit_s, until_stderr=False):
        """(seconds, passed, output), in seconds of processors, for the machine may have more to do.
        A line on stderr can be taken for a failure at once."""

        def limits():
            resource.setrlimit(resource.RLIMIT_CPU, (int(limit_s), int(limit_s)))
            resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))

        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                   errors="replace", preexec_fn=limits)  # fmt: skip
        watch = threading.Timer(30 * limit_s, process.kill)  # one that waits for ever
        watch.start()
        first = process.stderr.readline() if until_stderr else ""
        if first:
            process.kill()
        out, err = process.communicate()
        watch.cancel()
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        return seconds, process.returncode == 0, first + out + err

    def measured(self, suite):
        """[(file with names of tests, seconds)]: the quick tests, then the others."""
        program = self.build / "tests" / suite
        _, passed, output = self.timed([program, "~[slow]", "-d", "yes"], 600)
        if not passed:
            sys.exit(f"The tests fail without any mutant:\n{output[-4000:]}")
        seconds = collections.Counter()
        for match in re.finditer(r"^([0-9.]+) s: (.+)$", output, re.M):
            seconds[match.group(2)] += float(match.group(1))
        batches = []
        for is_quick in (True, False):
            names = sorted(name for name, s in seconds.items() if (s < QUICK_S) == is_quick)
            file = self.tree.parent / f"{suite}_{'quick' if is_quick else 'long'}.txt"
            file.write_text("\n".join(names) + "\n")
            batches.append((file, sum(seconds[name] for name in names)))
        return batches

    def test(self, mutant):
        """Returns (verdict, what caught it)."""
        ninja = ["ninja", "-C", self.build, "-j1"]
        if subprocess.run([*ninja, "determinism"], capture_output=True).returncode != 0:
            return "no build", ""
        objects = [name for name in self.changed() if name.endswith(".o")]
        if all((self.build / o).read_bytes() == (self.saved / o).read_bytes() for o in objects):
            return "same code", ""
        seconds, passed, output = self.timed([self.determinism(), "--few"],
                                             3 * self.determinism_s + SPARE_S, True)  # fmt: skip
        if not passed:
            return "caught", "determinism: " + output[:60]
        suite = SUITES[mutant.file.split("/")[0]]
        if subprocess.run([*ninja, suite], capture_output=True).returncode != 0:
            return "caught", suite + " does not compile"
        for file, usual_s in self.batches[suite]:
            command = [self.build / "tests" / suite, "-a", "-f", file]
            seconds, passed, output = self.timed(command, 3 * usual_s + SPARE_S)
            if not passed:
                test = re.search(r"^-{20,}\n(.+)\n", output, re.M)
                return "caught", test.group(1) if test else f"{suite}: {output[-60:].strip()}"
        return "survived", ""


def read_equivalent():
    """{(file, before, after): reason} from blocks of file, - line, + line, reason."""
    found = {}
    text = (ROOT / "tests/mutation/equivalent.txt").read_text()
    for block in text.split("\n\n"):
        lines = [line for line in block.splitlines() if line and not line.startswith("#")]
        if not lines:
            continue
        if len(lines) < 4 or lines[1][:2] != "- " or lines[2][:2] != "+ ":
            sys.exit(f"equivalent.txt: expected a file, '- line', '+ line' and a reason:\n{block}")
        found[lines[0], lines[1][2:], lines[2][2:]] = " ".join(line.strip() for line in lines[3:])
    return found


def report(results, skipped, seconds):
    by_kind = {kind: collections.Counter() for kind in mutators.KINDS}
    for mutant, verdict, _ in results:
        by_kind[mutant.kind][verdict] += 1
    caught = sum(verdict == "caught" for _, verdict, _ in results)
    print("\n| kind | mutants | caught |\n|---|---:|---:|")
    for kind, counts in by_kind.items():
        print(f"| {kind} | {counts.total()} | {counts['caught']} |")
    share = caught / max(1, len(results))
    print(f"| all | {len(results)} | {caught} ({100 * share:.1f} %) |\n")
    print(f"{seconds:.0f} s, {seconds / max(1, len(results)):.1f} s a mutant; left out: "
          + ", ".join(f"{count} {why}" for why, count in skipped.items()))  # fmt: skip
    for mutant, verdict, _ in results:
        if verdict == "survived":
            print(f"\nsurvived: {mutant.file}:{mutant.line}\n- {mutant.before}\n+ {mutant.after}")
    return share >= GOAL


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[2])
    parser.add_argument("--count", type=int, default=120, help="mutants to build and test")
    parser.add_argument("--seed", type=int, default=7, help="of the sample")
    parser.add_argument("--only", default="", help="mutants of which 'file: line' matches this")
    parser.add_argument("--list", action="store_true", help="print the sample, build nothing")
    parser.add_argument("--work", type=Path, default=ROOT / "build/mutation", help="folder to use")
    options = parser.parse_args()

    equivalent = read_equivalent()

    def drawn(root):
        return (m for m in mutators.sample(root, options.seed)
                if re.search(options.only, f"{m.file}: {m.before}"))  # fmt: skip

    if options.list:
        for _, m in zip(range(options.count), drawn(ROOT)):
            print(f"{m.file}:{m.line}: {m.kind}\n- {m.before}\n+ {m.after}\n")
        return 0
    if platform.machine() == "x86_64" and "avx2" not in Path("/proc/cpuinfo").read_text():
        sys.exit("A processor with AVX2 is needed.")
    bench = Bench(options.work.resolve())
    results, skipped, start = [], collections.Counter(), time.monotonic()
    for mutant in drawn(bench.tree):
        if len(results) == options.count:
            break
        if mutant.key() in equivalent:
            skipped["equivalent"] += 1
            continue
        source = bench.tree / mutant.file
        text, stat = source.read_text(), source.stat()
        source.write_text(text[: mutant.begin] + mutant.new + text[mutant.end :])
        verdict, by = bench.test(mutant)
        bench.restore(source, text, (stat.st_atime_ns, stat.st_mtime_ns))
        if verdict in ("no build", "same code"):
            skipped[verdict] += 1
            continue
        results.append((mutant, verdict, by))
        print(f"{len(results):4} {time.monotonic() - start:6.0f} s {verdict:8} {mutant.kind:8} "
              f"{mutant.file}:{mutant.line}  {by}", flush=True)  # fmt: skip
    return 0 if report(results, skipped, time.monotonic() - start) else 1


if __name__ == "__main__":
    sys.exit(main())
