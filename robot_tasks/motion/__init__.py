"""Reference motion: goals become straight, synchronized, time-parametrized movements."""

from robot_tasks.motion.generator import MotionGenerator
from robot_tasks.motion.overlay import Overlay
from robot_tasks.motion.profile import MotionLimits, TrapezoidalProfile
from robot_tasks.motion.spiral import ArchimedesSpiral, SteppedSpiral
from robot_tasks.motion.trajectory import Trajectory

__all__ = [
    "ArchimedesSpiral",
    "MotionGenerator",
    "MotionLimits",
    "Overlay",
    "SteppedSpiral",
    "Trajectory",
    "TrapezoidalProfile",
]
