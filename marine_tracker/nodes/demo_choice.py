"""What a demo shows, as parameters of its node `demo`: the page sets them, or `ros2 param set`.

scenario, recording  names; recording is empty where a scenario is shown
rate                 simulated seconds in a second
scenarios, recordings  what can be chosen; read only
run                  counts what was shown so far; read only
"""

from collections.abc import Callable
from typing import Any, Protocol

from rcl_interfaces.msg import ParameterDescriptor, ParameterType, SetParametersResult
from rclpy.parameter import Parameter

from .diagnostics import one_line
from .targets_listener import TargetsListener

NAME = 'demo'
CHOSEN = ('scenario', 'recording', 'rate')


class Shown(Protocol):
    """A NamedTuple of the values of CHOSEN."""

    def _asdict(self) -> dict[str, Any]: ...

    def _replace(self, **values: Any) -> 'Shown': ...


class Offers(Protocol):
    """Names of what can be chosen."""

    @property
    def scenarios(self) -> dict[str, str]:
        """Each with what it stands for."""

    @property
    def recordings(self) -> dict[str, str]:
        """Likewise."""


class DemoChoice:
    """The node, spun with the listener.

    check(shown) raises ValueError where that cannot be shown.
    changed  whether something else was chosen than what was taken last
    """

    def __init__(
        self, listener: TargetsListener, offers: Offers, shown: Any, check: Callable[[Any], object]
    ) -> None:
        self._offers, self._check = offers, check
        self._shown = self._taken = shown
        self._runs = 1
        self._again = False
        self._node = listener.add(NAME)
        fixed = ParameterDescriptor(read_only=True, type=ParameterType.PARAMETER_STRING_ARRAY)
        self._node.declare_parameter('scenarios', [*offers.scenarios], fixed)
        self._node.declare_parameter('recordings', [*offers.recordings] or [''], fixed)
        self._node.declare_parameter('run', 1)
        for name, value in shown._asdict().items():
            self._node.declare_parameter(name, value)
        self._node.add_on_set_parameters_callback(self._on_set)

    @property
    def changed(self) -> bool:
        """See the class."""
        return self._again

    def take(self) -> Any:
        """What is to be shown now."""
        self._again = False
        self._runs += 1
        self._node.set_parameters([Parameter('run', value=self._runs)])
        return self._shown

    def _on_set(self, parameters: list[Parameter]) -> SetParametersResult:
        given = {one.name: one.value for one in parameters}
        if given.keys() <= {'run'} and given['run'] == self._runs:
            return SetParametersResult(successful=True)
        try:
            for name, value in given.items():
                if name not in CHOSEN:
                    raise ValueError(f'{name} cannot be set')
                known = getattr(self._offers, f'{name}s', None)
                if known is not None and value not in known and (value or name == 'scenario'):
                    raise ValueError(f'{name} is {value!r}: none of those that are offered')
            shown = self._shown._replace(**given)
            self._check(shown)
        except (ValueError, OSError) as error:
            return SetParametersResult(successful=False, reason=one_line(error, 300))
        self._shown, self._again = shown, True
        return SetParametersResult(successful=True)
