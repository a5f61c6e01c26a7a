from collections.abc import Sequence

__version__: str

class ForceState:
    step: int
    sense_ns: int
    force: list[float]
    torque: list[float]
    grip: float
    flags: int

class MotorForce:
    force: list[float]
    torque: list[float]
    along: list[float]
    grip: float

class Device:
    def __init__(
        self, tool: int = 0, *, domain: int = 0, interface: str = "", peers: Sequence[str] = ..., keys: str = "",
        max_force: float = 10, max_torque: float = 3, max_grip: float = 1, max_force_rate: float = 500
    ) -> None: ...
    def write(self, dofs: Sequence[float], sense_ns: int | None = None) -> bool: ...
    def motors(self) -> MotorForce: ...
    def fade(self) -> MotorForce: ...
    def take(self) -> ForceState | None: ...
    def wait(self, seconds: float) -> bool: ...
    @property
    def written(self) -> int: ...
    @property
    def limp(self) -> bool: ...
    @property
    def strange(self) -> int: ...
    @property
    def refused(self) -> int: ...
