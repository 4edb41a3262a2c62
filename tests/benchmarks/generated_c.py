"""CasADi's generated C under ``-Ofast``, in a loop over states in the same file, on some threads."""

import ctypes
import os
import shutil
import subprocess
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

COMPILER = os.environ.get("CC") or shutil.which("gcc") or shutil.which("cc")
COMPILED = ("-Ofast", "-march=native", "-fopenmp", "-fPIC", "-c", "point.c", "-o", "point.o")
LINKED = ("-shared", "-fopenmp", "point.o", "-o", "point.so", "-lm")
"""Without -Ofast: with it, loading the file would round subnormal numbers to 0 in all of this process."""
LOOP = """
#include <omp.h>
void each(long count, long n, long threads, const double *q, const double *e, const double *w, double *out) {
  #pragma omp parallel for num_threads(threads)
  for (long i = 0; i < count; ++i) {
    const double *arg[3] = {q + i * n, e + i * n, w + i * n};
    double *res[1] = {out + i}, work[WORK];
    point(arg, res, 0, work, 0);
  }
}
"""


def loop(point, n, threads):
    """A function of arrays (count, n) of q, e and w from a CasADi function of one state."""
    with TemporaryDirectory(prefix="lyapcheck-") as folder:
        place = Path.cwd()
        os.chdir(folder)  # CasADi writes only there
        try:
            point.generate("point.c")
        finally:
            os.chdir(place)
        source = Path(folder, "point.c").read_text(encoding="utf-8")
        Path(folder, "point.c").write_text(source + LOOP.replace("WORK", str(point.sz_w() + 1)))
        assert COMPILER is not None
        for words in (COMPILED, LINKED):
            subprocess.run([COMPILER, *words], cwd=folder, check=True)
        each = ctypes.CDLL(str(Path(folder, "point.so"))).each
    pointer = np.ctypeslib.ndpointer(np.float64, flags="C_CONTIGUOUS")
    each.argtypes = [ctypes.c_long, ctypes.c_long, ctypes.c_long, pointer, pointer, pointer, pointer]

    def call(q, e, w):
        out = np.empty(len(q))
        each(len(q), n, threads, q, e, w, out)
        return out

    return call
