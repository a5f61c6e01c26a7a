"""palpate, a haptic simulator of soft tissue: scenes, tensors, static states, runs in lock step, topic logs."""
import os
import pathlib


def _choose_blas() -> None:
    """OpenBLAS 0.3.21 takes the slowest code on processors that are newer than it; it reads this when it is loaded."""
    words = set()
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("flags"):
            words = set(line.split())
            break
    if {"avx512f", "avx512dq", "avx512bw", "avx512vl"} <= words:
        os.environ.setdefault("OPENBLAS_CORETYPE", "SkylakeX")
    elif {"avx2", "fma"} <= words:
        os.environ.setdefault("OPENBLAS_CORETYPE", "Haswell")


_choose_blas()

from ._core import Archive, Scene, Simulator, __version__, check, read_log, solve, topics_in  # noqa: E402

__all__ = ["Archive", "Scene", "Simulator", "check", "read_log", "solve", "topics_in", "__version__"]
