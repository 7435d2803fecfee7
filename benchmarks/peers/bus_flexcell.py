"""The skill bus: topics, services, actions and leases as states and robots use them."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable

from benchmarks.peers.joint_states import new_joint_state
from benchmarks.sample import Reactions, Sample, Stopwatch
from engine.bus import ActiveGoal, Holder, SkillBus
from engine.clock import new_clock
from engine.messages import GripperState, JointState
from engine.skills.gripper import GraspResult, GripperFeedback, GripperOpen, ReadGripper

_TOPIC = "left/joint_states"
_MANY = 1000


def publish(watch: Stopwatch, subscribers: int) -> Sample:
    """Publish one ready message to callbacks, 1000 times."""

    async def main() -> Sample:
        topic = SkillBus(new_clock()).topic(_TOPIC, JointState)
        for _ in range(subscribers):
            topic.subscribe(_Last().take)
        message = new_joint_state(0)
        return watch.measure(_MANY, lambda: _repeat(lambda: topic.publish(message)))

    return asyncio.run(main())


def joint_states(watch: Stopwatch, subscribers: int) -> Sample:
    """Make a new message and publish it to callbacks, 1000 times."""

    async def main() -> Sample:
        topic = SkillBus(new_clock()).topic(_TOPIC, JointState)
        for _ in range(subscribers):
            topic.subscribe(_Last().take)

        def work() -> None:
            for tick in range(_MANY):
                topic.publish(new_joint_state(tick))

        return watch.measure(_MANY, work)

    return asyncio.run(main())


def latest(watch: Stopwatch) -> Sample:
    """Look the topic up by name and read its latest message, 1000 times."""

    async def main() -> Sample:
        bus = SkillBus(new_clock())
        bus.topic(_TOPIC, JointState).publish(new_joint_state(0))
        return watch.measure(_MANY, lambda: _repeat(lambda: bus.topic(_TOPIC, JointState).latest))

    return asyncio.run(main())


def stream(watch: Stopwatch, subscribers: int) -> Sample:
    """Publish to tasks that await each message, 1000 times."""

    async def main() -> Sample:
        topic = SkillBus(new_clock()).topic(_TOPIC, JointState)
        message = new_joint_state(0)

        async def read() -> None:
            with topic.stream() as messages:
                for _ in range(_MANY):
                    await messages.next()

        async def work() -> None:
            readers = [asyncio.create_task(read()) for _ in range(subscribers)]
            await asyncio.sleep(0)
            for _ in range(_MANY):
                topic.publish(message)
                await asyncio.sleep(0)
            await asyncio.gather(*readers)

        return await watch.measure_async(_MANY, work)

    return asyncio.run(main())


def call(watch: Stopwatch) -> Sample:
    """Ask a service, 1000 times."""

    async def main() -> Sample:
        bus = SkillBus(new_clock())
        state = GripperState(time_s=0, width_m=0.04, force_n=0, held=False)

        async def read(request: ReadGripper) -> GripperState:
            return state

        bus.advertise_service(ReadGripper, read, namespace="left/gripper")

        async def work() -> None:
            request = ReadGripper()
            for _ in range(_MANY):
                await bus.call(request, to="left/gripper")

        return await watch.measure_async(_MANY, work)

    return asyncio.run(main())


def perform(watch: Stopwatch) -> Sample:
    """Send a goal that is accepted, gives feedback and succeeds, and await its result, 1000 times."""

    async def main() -> Sample:
        bus = SkillBus(new_clock())
        result = GraspResult(held=False, width_m=0.08, force_n=0)
        feedback = GripperFeedback(width_m=0.05)

        async def open_gripper(goal: GripperOpen, handle: ActiveGoal[GripperFeedback]) -> GraspResult:
            handle.accept()
            handle.feedback(feedback)
            return result

        bus.advertise_action(GripperOpen, open_gripper, namespace="left/gripper")

        async def work() -> None:
            goal, holder = GripperOpen(), Holder("bench", "root/open")
            for _ in range(_MANY):
                await bus.send_goal(goal, to="left/gripper", holder=holder).result()

        return await watch.measure_async(_MANY, work)

    return asyncio.run(main())


def lease(watch: Stopwatch) -> Sample:
    """Lease an arm and its gripper and give them back, 1000 times."""

    async def main() -> Sample:
        leases, holder = SkillBus(new_clock()).leases, Holder("bench", "root/pick")
        resources = ("left", "left/gripper")

        def work() -> None:
            for _ in range(_MANY):
                leases.acquire(resources, holder)
                leases.release(resources, holder)

        return watch.measure(_MANY, work)

    return asyncio.run(main())


def across_threads(watch: Stopwatch, events: int) -> Sample:
    """Publish from another thread through `post`; a task that awaits the stream gets the message."""

    async def main() -> Sample:
        bus = SkillBus(new_clock())
        topic = bus.topic(_TOPIC, JointState)
        message = new_joint_state(0)
        reactions = Reactions(events, lambda: bus.post(lambda: topic.publish(message)))
        done = False
        with topic.stream() as messages:
            while not done:
                reactions.waiting()
                await messages.next()
                done = reactions.entered()
        return reactions.sample()

    return asyncio.run(main())


class _Last:
    """A subscriber that keeps the last message, as a viewer or a controller does."""

    def __init__(self) -> None:
        self._kept: deque[JointState] = deque(maxlen=1)

    def take(self, message: JointState) -> None:
        self._kept.append(message)


def _repeat(work: Callable[[], object]) -> None:
    for _ in range(_MANY):
        work()
