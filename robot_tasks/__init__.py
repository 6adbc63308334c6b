"""Robot skills to tune: MuJoCo rollouts of behaviour trees under Cartesian impedance control.

The functions here are evaluators: called with a configuration and a seed, they run one rollout and return numbers.
Importing the package is cheap; MuJoCo is loaded at the first call.
"""

from __future__ import annotations

from collections.abc import Mapping

__all__ = ["obstacle_avoidance"]


def obstacle_avoidance(
    configuration: Mapping[str, float], seed: int = 0, *, as_published_code: bool = False
) -> Mapping[str, float]:
    """Carry a tool over an engine with a KUKA iiwa 7; see `docs/robot_tasks.md`.

    Parameters
    ----------
    configuration
        The parameters ``mp1_position_y``, ``mp1_position_z``, ``mp2_position_y``, ``mp2_position_z``, ``mp2_threshold``
        and ``mp3_threshold``, all in [m].
    seed
        Chooses the start state of the arm and where exactly engine and block stand.
    as_published_code
        Whether to take the choices of the published code where they differ from the paper's text.

    Returns
    -------
    Mapping
        The objectives ``performance`` and ``safety``, both to be maximized, and further numbers.

    Raises
    ------
    robot_tasks.errors.ParameterError
        If a parameter is missing, unknown, not finite or out of bounds.
    robot_tasks.errors.SimulationError
        If the physics broke down; the rollout has no score.
    """
    from robot_tasks.evaluation import evaluate

    return evaluate("obstacle_avoidance", configuration, seed, as_published_code=as_published_code)
