"""Reference motion: goals become straight, synchronized, time-parametrized movements."""

from robot_tasks.motion.generator import MotionGenerator
from robot_tasks.motion.overlay import Overlay
from robot_tasks.motion.profile import MotionLimits, TrapezoidalProfile
from robot_tasks.motion.trajectory import Trajectory

__all__ = ["MotionGenerator", "MotionLimits", "Overlay", "Trajectory", "TrapezoidalProfile"]
