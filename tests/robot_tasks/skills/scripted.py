"""A behaviour that answers from a script and keeps a diary."""

from robot_tasks.geometry import TOOL_DOWN, Pose
from robot_tasks.skills import Behaviour, SkillContext, Status

SUCCESS, FAILURE, RUNNING, IDLE = Status.SUCCESS, Status.FAILURE, Status.RUNNING, Status.IDLE


class Scene(dict[str, Pose]):
    """A world without physics: poses by name."""

    def pose_of(self, name: str) -> Pose:
        return self[name]


def context(tip=(0.0, 0.0, 0.0), **poses: Pose) -> SkillContext:
    world = Scene(tool_tip=Pose(tip, TOOL_DOWN)) | poses
    return SkillContext(tip=tip, world=Scene(world), goal=Pose((0.0, 0.0, 0.0), TOOL_DOWN))


class Scripted(Behaviour):
    """Answer the statuses of a script one after the other, the last one for ever."""

    def __init__(self, *script: Status) -> None:
        super().__init__()
        self.script = list(script)
        self.diary: list[str] = []

    def _initialise(self, context: SkillContext) -> None:
        self.diary.append("start")

    def _update(self, context: SkillContext) -> Status:
        self.diary.append("update")
        return self.script.pop(0) if len(self.script) > 1 else self.script[0]

    def _terminate(self, context: SkillContext, status: Status) -> None:
        self.diary.append(status.value)

    @property
    def n_updates(self) -> int:
        return self.diary.count("update")


def ticks(behaviour: Behaviour, n: int) -> list[Status]:
    return [behaviour.tick(context()) for _ in range(n)]
