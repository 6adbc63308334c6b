"""Controllers: from a reference pose to forces on the arm."""

from robot_tasks.control.impedance import ImpedanceController
from robot_tasks.control.ramp import Ramp

__all__ = ["ImpedanceController", "Ramp"]
