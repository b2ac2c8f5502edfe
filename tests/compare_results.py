"""Compare two folders of results: the same files, the same words, the same numbers but for rounding.

Tables must agree to their digits, give or take one in the last; of JSON files the figures that a reader would quote
count, not the coefficients behind them. Pictures carry fonts and renderer versions and are left out.
"""

import json
import re
import sys
from pathlib import Path

NUMBER = re.compile(r"-?\d+\.?\d*(?:[eE][+-]?\d+)?")
PICTURES = {".svg", ".png", ".pdf"}
QUOTED = {"objective", "lower_bound", "limit", "status", "B", "C", "D", "J", "rms_c", "row", "verdict"}
RELATIVE, ABSOLUTE = 2e-6, 1e-9


def files(folder: Path) -> set[Path]:
    return {f.relative_to(folder) for f in folder.rglob("*") if f.is_file() and f.suffix not in PICTURES}


def close(first: str, second: str) -> bool:
    a, b = float(first), float(second)
    return abs(a - b) <= ABSOLUTE + RELATIVE * max(abs(a), abs(b))


def same_text(first: str, second: str) -> bool:
    if first == second:
        return True
    words = [" ".join(re.sub(r"-{2,}", "--", NUMBER.sub("#", text)).split()) for text in (first, second)]
    numbers = [NUMBER.findall(text) for text in (first, second)]
    return words[0] == words[1] and all(close(a, b) for a, b in zip(*numbers, strict=True))


def quoted(data: object, path: str = "") -> dict[str, str]:
    found: dict[str, str] = {}
    if isinstance(data, dict):
        for key, value in data.items():
            if key in QUOTED and not isinstance(value, dict | list):
                found[f"{path}/{key}"] = str(value)
            elif key == "value":
                found[f"{path}/value"] = str(value)
            elif key not in {"certificate", "power_certificate", "law"}:
                found |= quoted(value, f"{path}/{key}")
    elif isinstance(data, list):
        for i, value in enumerate(data):
            found |= quoted(value, f"{path}[{i}]")
    return found


def same(first: Path, second: Path) -> bool:
    texts = [file.read_text(encoding="utf-8") for file in (first, second)]
    if first.suffix != ".json":
        return same_text(*texts)
    parts = [quoted(json.loads(text)) for text in texts]
    return parts[0].keys() == parts[1].keys() and all(same_text(parts[0][key], parts[1][key]) for key in parts[0])


def main(first: Path, second: Path) -> int:
    missing = files(first) ^ files(second)
    differing = [file for file in sorted(files(first) & files(second)) if not same(first / file, second / file)]
    for file in sorted(missing):
        print(f"only on one side: {file}")  # noqa: T201 - it is a command
    for file in differing:
        print(f"differs: {file}")  # noqa: T201 - it is a command
    return 1 if missing or differing else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]), Path(sys.argv[2])))
