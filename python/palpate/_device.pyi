from collections.abc import Sequence

class ForceState:
    step: int
    sense_ns: int
    force: list[float]
    torque: list[float]
    grip: float
    flags: int

class Device:
    def __init__(
        self, tool: int = 0, *, domain: int = 0, interface: str = "", peers: Sequence[str] = ..., keys: str = ""
    ) -> None: ...
    def write(self, dofs: Sequence[float], sense_ns: int | None = None) -> bool: ...
    def take(self) -> ForceState | None: ...
    def wait(self, seconds: float) -> bool: ...
    @property
    def written(self) -> int: ...
