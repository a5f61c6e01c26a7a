"""palpate, a haptic simulator of soft tissue: scenes, tensors, static states, runs in lock step, topic logs, drivers of devices."""
import importlib
import importlib.util
import os
import pathlib
from typing import TYPE_CHECKING, Any


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

from ._device import Device, ForceState, __version__  # noqa: E402

if TYPE_CHECKING:
    from ._core import Archive, Scene, Simulator, check, read_log, solve, topics_in

_OF_THE_SIMULATOR = ["Archive", "Scene", "Simulator", "check", "read_log", "solve", "topics_in"]
__all__ = ["Device", "ForceState", "__version__"]
if importlib.util.find_spec("palpate._core"):
    __all__ += _OF_THE_SIMULATOR


def __getattr__(name: str) -> Any:
    """The simulator's libraries are loaded with the first of its names: a driver goes without them."""
    if name not in _OF_THE_SIMULATOR:
        raise AttributeError(f"module 'palpate' has no attribute '{name}'")
    try:
        core = importlib.import_module("palpate._core")
    except ModuleNotFoundError as error:
        if error.name != "palpate._core":
            raise
        raise ImportError(f"this installation has only palpate.Device: {name} is in the package python3-palpate, or in a build with "
                          "the preset 'python' (docs/python.md)") from None
    return getattr(core, name)
