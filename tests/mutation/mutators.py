"""Where the kernels can be changed by one small arithmetic slip, and what the slip looks like.

Every slip is one that a person could make and that a reader could miss: a sign, a product, a bound
that is off by one, a shift, a constant, the wrong one of min and max or of and and or, a rounding
term left out.
"""

import hashlib
import re
from dataclasses import dataclass
from pathlib import Path

# Kernels: the scalar truth, the SIMD code, and the rules and the arithmetic that both share.
KERNELS = (
    "rasterizer/fixed.h",
    "rasterizer/internal/*-inl.h",
    "rasterizer/internal/*_reference.*",
    "rasterizer/internal/triangle_setup.*",
    "postfx/internal/*-inl.h",
    "postfx/internal/*_reference.*",
    "postfx/internal/*_rules.h",
    "postfx/internal/rules.h",
    "postfx/internal/*_pixel.h",
)

KINDS = ("sign", "product", "bound", "shift", "constant", "minmax", "logic", "rounding")


@dataclass(frozen=True)
class Mutant:
    """`text[begin:end]` of `file` becomes `new`."""

    file: str
    kind: str
    begin: int
    end: int
    new: str
    line: int  # from 1
    before: str  # the line as it is, and …
    after: str  # … as it becomes, both without blanks at the ends
    order: str = ""  # the sample takes the lowest

    def key(self):
        return (self.file, self.before, self.after)


def masked(text):
    """The text with blanks for comments, strings, characters and preprocessor lines."""
    pattern = re.compile(
        r"//[^\n]*|/\*.*?\*/|\"(?:\\.|[^\"\\\n])*\"|(?<![\w])'(?:\\.|[^'\\\n])'"
        r"|^[ \t]*#(?:[^\n]*\\\n)*[^\n]*",
        re.S | re.M,
    )
    return pattern.sub(lambda m: re.sub(r"[^\n]", " ", m.group()), text)


def arguments(code, opening):
    """Ranges of the arguments of the call whose parenthesis opens at `opening`."""
    depth, start, found = 0, opening + 1, []
    for at in range(opening, len(code)):
        if code[at] in "([{":
            depth += 1
        elif code[at] in ")]}":
            depth -= 1
            if depth == 0:
                return found + [(start, at)]
        elif code[at] == "," and depth == 1:
            found.append((start, at))
            start = at + 1
    return []


def _replaced(code, kind, pattern, new):
    """(kind, begin, end, new) for each match; `new` is a text or a function of the match."""
    for match in re.finditer(pattern, code):
        for text in [new] if isinstance(new, str) else new(match):
            yield kind, match.start(1), match.end(1), text


def _constants(match):
    value = int(match.group(1))
    return [str(value + 1)] + ([str(value - 1)] if value > 0 else [])


def _shifts(match):
    value = int(match.group(1))
    return [str(value + 1)] + ([str(value - 1)] if value > 1 else [])


def _roundings(code, text):
    """Calls that round, without their rounding."""
    for match in re.finditer(r"\broundShift\(", code):
        parts = [text[a:b].strip() for a, b in arguments(code, match.end() - 1)]
        if len(parts) == 2 and not parts[0].startswith("I "):
            end = arguments(code, match.end() - 1)[-1][1] + 1
            yield "rounding", match.start(), end, f"(({parts[0]}) >> ({parts[1]}))"
    for match in re.finditer(r"\broundToInt\((?!float)", code):
        (begin, end), *_ = arguments(code, match.end() - 1) or [(0, 0)]
        yield "rounding", match.start(), end + 1, f"int32_t(std::floor({text[begin:end]}))"
    for match in re.finditer(r"\broundLanes\((?!D)", code):
        parts = [text[a:b].strip() for a, b in arguments(code, match.end() - 1)]
        if len(parts) == 2:
            end = arguments(code, match.end() - 1)[-1][1] + 1
            new = f"hn::ConvertTo(hn::RebindToSigned<decltype({parts[0]})>(), hn::Floor({parts[1]}))"
            yield "rounding", match.start(), end, new
    yield from _replaced(code, "rounding", r"\b(roundShift)<\w", "hn::ShiftRight")
    # (x + half) >> n
    yield from _replaced(code, "rounding", r"( \+ [\w /]+)\) >> ", "")
    for match in re.finditer(r"\bShiftRight<[^>]*>\((hn::Add\()", code):
        parts = arguments(code, match.end() - 1)
        if len(parts) == 2:
            yield "rounding", match.start(1), parts[1][1] + 1, text[slice(*parts[0])]


def _slips(code, text):
    swap = {
        "+": "-", "-": "+", "+=": "-=", "-=": "+=", "Add": "Sub", "Sub": "Add",
        "<": "<=", "<=": "<", ">": ">=", ">=": ">", "Lt": "Le", "Le": "Lt", "Gt": "Ge", "Ge": "Gt",
        "min": "max", "max": "min", "Min": "Max", "Max": "Min",
        "&&": "||", "||": "&&", "And": "Or", "Or": "And",
    }  # fmt: skip
    swapped = lambda match: [swap[match.group(1)]]
    yield from _replaced(code, "sign", r"[\w)\]] (\+=?|-=?) (?=[\w(])", swapped)
    yield from _replaced(code, "sign", r"\bhn::(Add|Sub)\(", swapped)
    yield from _replaced(code, "product", r"[\w)\]] (\*) (?=[\w(])", "+")
    yield from _replaced(code, "product", r"\bhn::(Mul)\(", "Add")
    yield from _replaced(code, "bound", r"[\w)\]] (<=?|>=?) (?=[\w(-])", swapped)
    yield from _replaced(code, "bound", r"\bhn::(Lt|Le|Gt|Ge)\(", swapped)
    yield from _replaced(code, "shift", r" (<<|>>) (?=[\w(])", lambda m: [f"{m.group(1)} {n} +" for n in (1, -1)])
    yield from _replaced(code, "shift", r"\b(?:Shift(?:Left|Right)|roundShift)<(\d+)>", _shifts)
    yield from _replaced(code, "constant", r"(?<![\w.<\[])(\d+)(?![\w.\]'])", _constants)
    yield from _replaced(code, "constant", r"(?<![\w.])(\d+\.\d+)(?=f\b)", lambda m: [str(float(m.group(1)) + 1)])
    yield from _replaced(code, "minmax", r"\bstd::(min|max)\(", swapped)
    yield from _replaced(code, "minmax", r"\bhn::(Min|Max)\(", swapped)
    yield from _replaced(code, "logic", r" (&&|\|\|)(?= |\n)", swapped)
    yield from _replaced(code, "logic", r"\bhn::(And|Or)\(", swapped)
    yield from _roundings(code, text)


def mutants_of(root, file, seed):
    """All mutants of one file. Their order in the sample depends on nothing but the seed and on
    what they change, so that work on one kernel leaves the sample of the others alone."""
    text = (root / file).read_text()
    code = masked(text)
    seen = {}
    for kind, begin, end, new in _slips(code, text):
        first = text.rfind("\n", 0, begin) + 1
        last = text.find("\n", end)
        before, after = text[first:last], text[first:begin] + new + text[end:last]
        if re.match(r"\s*(template|static_assert|case|alignas)\b", before):
            continue
        before, after = (" ".join(part.split()) for part in (before, after))
        repeat = seen[before, after] = seen.get((before, after), 0) + 1
        name = f"{seed}|{file}|{before}|{after}|{repeat}"
        order = hashlib.sha256(name.encode()).hexdigest()
        line = text.count("\n", 0, begin) + 1
        yield Mutant(file, kind, begin, end, new, line, before, after, order)


def sample(root, seed):
    """Mutants of the kernels in a fixed order: the kinds in turns, no line twice."""
    files = sorted({str(f.relative_to(root)) for p in KERNELS for f in Path(root).glob(p)})
    by_kind = {kind: [] for kind in KINDS}
    for file in files:
        for mutant in mutants_of(Path(root), file, seed):
            by_kind[mutant.kind].append(mutant)
    for kind in KINDS:
        by_kind[kind].sort(key=lambda m: m.order)
    taken = set()
    while any(by_kind.values()):
        for kind in KINDS:
            fresh = (m for m in by_kind[kind] if (m.file, m.before) not in taken)
            mutant = next(fresh, None)
            by_kind[kind] = list(fresh)
            if mutant is not None:
                taken.add((mutant.file, mutant.before))
                yield mutant
