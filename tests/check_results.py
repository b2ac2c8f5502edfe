"""Whether the results that were written anew say the same as those that are kept, but for a processor's rounding."""

import sys
from pathlib import Path

from tests.internals.files import say_the_same


def differences(kept: Path, written: Path, names: set[str], unsteady: set[str]) -> list[str]:
    """What is in one place alone, and what says something else; `names` are those that the problem files wrote."""
    files = [file.relative_to(kept) for file in kept.rglob("*") if file.is_file()]
    there = {file.as_posix() for file in files if file.parts[0] not in unsteady}
    found = [f"{name}: {'not written' if name in there else 'not kept'}" for name in sorted(there ^ names)]
    for name in sorted(there & names):
        first, second = ((folder / name).read_bytes() for folder in (kept, written))
        if not say_the_same(first, second, Path(name).suffix):
            found.append(f"{name}: says something else")
    return found


def main() -> int:
    """Print what differs between two places, of the names listed in a file; folders that are named are left out."""
    kept, written, listed = map(Path, sys.argv[1:4])
    names = {line.removeprefix("results/") for line in listed.read_text().splitlines()}
    found = differences(kept, written, names, unsteady=set(sys.argv[4:]))
    sys.stderr.writelines(f"{line}\n" for line in found)
    return bool(found)


if __name__ == "__main__":
    sys.exit(main())
