"""Function blocks as matiec compiles them, an IEC 61131-3 compiler to C that keeps to the grammar of the standard.

It is in no registry: `MATIEC` names the folder of a build, with `iec2c` and `lib`, or `iec2c` is on the path.
"""

import os
import shutil
import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

COMPILER = shutil.which("gcc") or shutil.which("cc")
FOLDER = os.environ.get("MATIEC") or str(Path(shutil.which("iec2c") or "/").parent)
MISSING = (
    "there is no C compiler"
    if COMPILER is None
    else None
    if (Path(FOLDER) / "iec2c").is_file() and (Path(FOLDER) / "lib" / "C" / "iec_std_lib.h").is_file()
    else "there is no matiec: let MATIEC name the folder of its iec2c and lib"
)

_PROGRAM = """\
#include <stdio.h>
#include "iec_std_lib.h"
TIME __CURRENT_TIME;
BOOL __DEBUG;
#include "POUS.h"
#include "POUS.c"
int main(void)
{{
    static {block} data;
    double input[{count}];
    {block}_init__(&data, 0);
    while (scanf("{formats}", {places}) == {count}) {{
{assignments}
        {block}_body__(&data);
        printf("{printed}\\n", {results});
    }}
    return 0;
}}
"""


def outputs(
    folder: Path, source: str, name: str, inputs: Mapping[str, Sequence[float]], results: Sequence[str]
) -> NDArray[np.float64]:
    """What a block answers, a row for each call: `inputs` has for each input its values from call to call."""
    (folder / "block.st").write_text(source, "utf-8")
    command = [str(Path(FOLDER) / "iec2c"), "-I", str(Path(FOLDER) / "lib"), "-T", str(folder), "block.st"]
    answer = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert answer.returncode == 0, answer.stderr
    count = len(inputs)
    program = _PROGRAM.format(
        block=name.upper(),
        count=count,
        formats=" ".join(["%la"] * count),
        places=", ".join(f"&input[{i}]" for i in range(count)),
        assignments="\n".join(f"        __SET_VAR(data.,{key.upper()},,input[{i}]);" for i, key in enumerate(inputs)),
        printed=" ".join(["%a"] * len(results)),
        results=", ".join(f"(double)__GET_VAR(data.{result.upper()})" for result in results),
    )
    (folder / "main.c").write_text(program, "utf-8")
    library = str(Path(FOLDER) / "lib" / "C")
    # neither its library nor its code is free of warnings
    compilation = [str(COMPILER), "-w", "-O1", f"-I{library}", f"-I{folder}", "main.c", "-o", "main", "-lm"]
    subprocess.run(compilation, cwd=folder, check=True)
    rows = zip(*inputs.values(), strict=True)
    text = "\n".join(" ".join(float(value).hex() for value in row) for row in rows)
    run = subprocess.run([str(folder / "main")], input=text, capture_output=True, text=True, check=True)
    return np.array([[float.fromhex(cell) for cell in line.split()] for line in run.stdout.splitlines()])
