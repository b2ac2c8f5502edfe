"""Benchmark: what a certified law costs, beside plain CasADi and HiGHS on the same problem in the same run.

Run it with `make bench` or `python -m tests.bench`. It prints tables and writes nothing. Times are medians.
"""

import os

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[name] = "1"
os.environ["MPLBACKEND"] = "Agg"

from tests.bench import explorer, growth, machines, run_time, startup, study  # noqa: E402  # threads are counted when numpy is loaded
from tests.bench.report import main  # noqa: E402

main()
study.main()
growth.main()
machines.main()
run_time.main()
startup.main()
explorer.main()
