"""The skill bus: topics, services, actions, parameters and leases of one cell, in one process.

It belongs to the event loop that created it. Other threads use `post` only.
"""

from __future__ import annotations

import asyncio
import inspect
from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from types import TracebackType
from typing import Any, Self, TypeVar, cast

from engine.bus.action import ActiveGoal, GoalHandle, execute_goal
from engine.bus.handler_signature import verify_handler
from engine.bus.lease import Holder, LeaseTable
from engine.bus.parameter_server import ParameterServer
from engine.bus.topic import Topic
from engine.clock import Clock
from engine.errors import BusError, FlexcellError, GoalRejected, NoSuchSkill, SkillFailed
from engine.skill import Action, Service, Skill
from engine.skills.goal_end import GoalEnd
from engine.wording.suggestions import did_you_mean

R = TypeVar("R")
F = TypeVar("F")
M = TypeVar("M")
A = TypeVar("A", bound=Action[Any, Any])
Q = TypeVar("Q", bound=Service[Any])

ANONYMOUS_HOLDER = Holder("nobody")


@dataclass(frozen=True)
class _ActionServer:
    skill: type[Action[Any, Any]]
    handler: Callable[[Any, ActiveGoal[Any]], Awaitable[Any]]
    exclusive: str


@dataclass(frozen=True)
class _ServiceServer:
    skill: type[Service[Any]]
    handler: Callable[[Any], Any]
    commands: str


@dataclass(frozen=True)
class BusEntry:
    """One line of the bus listing."""

    kind: str
    name: str
    type: str
    detail: str


class _TookTooLong(Exception):
    """A service has not answered in time."""


class SkillBus:
    """Connects states and robots by name.

    Args:
        clock: Its time.
        service_timeout_s: The time within which a service answers; None to wait for as long as it takes.
    """

    def __init__(self, clock: Clock, *, service_timeout_s: float | None = None) -> None:
        self.clock = clock
        self._service_timeout_s = service_timeout_s
        self.leases = LeaseTable(now_s=clock.now_s)
        self.parameters = ParameterServer()
        self._loop = asyncio.get_running_loop()
        self._topics: dict[str, Topic[Any]] = {}
        self._topic_watchers: tuple[Callable[[Topic[Any]], None], ...] = ()
        self._services: dict[str, _ServiceServer] = {}
        self._actions: dict[str, _ActionServer] = {}
        self._running: dict[str, ActiveGoal[Any]] = {}
        self._goals: dict[GoalHandle[Any, Any], asyncio.Task[GoalEnd[Any]]] = {}
        self._goal_count = 0
        self._reasons: dict[str, Callable[[str], str]] = {}

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Cancel all active goals and wait until every handler has ended."""
        await self.cancel_goals()

    async def cancel_goals(self, run: str | None = None) -> None:
        """Cancel the goals of one run (of all holders when None) and wait for their ends."""
        selected = [(h, t) for h, t in self._goals.items() if run is None or h.holder_run == run]
        for handle, _ in selected:
            handle.cancel()
        if selected:
            await asyncio.wait([task for _, task in selected])

    def goals(self, run: str | None = None) -> tuple[GoalHandle[Any, Any], ...]:
        """Return the active goals of one run, or of all holders when None."""
        return tuple(h for h in self._goals if run is None or h.holder_run == run)

    def post(self, callback: Callable[[], None]) -> None:
        """Run `callback` on the loop thread; the only method for other threads."""
        self._loop.call_soon_threadsafe(callback)

    def topic(self, name: str, kind: type[M]) -> Topic[M]:
        """Return the topic `name`, created at first use.

        Raises:
            BusError: the topic exists with another message type.
        """
        known = self._topics.get(name)
        if known is None:
            known = self._topics[name] = Topic(name, kind, self.clock)
            for callback in self._topic_watchers:
                callback(known)
        if known.kind is not kind:
            raise BusError(f"this topic carries {known.kind.__name__}, not {kind.__name__}", where=name)
        return known

    def watch_topics(self, callback: Callable[[Topic[Any]], None]) -> Callable[[], None]:
        """Call `callback` with every present and future topic; returns a function that ends this."""
        self._topic_watchers = (*self._topic_watchers, callback)
        for topic in tuple(self._topics.values()):
            callback(topic)
        return lambda: self._unwatch_topics(callback)

    def find_topic(self, name: str) -> Topic[Any]:
        """Return an existing topic of any type; raises BusError when it does not exist."""
        if name not in self._topics:
            raise BusError("no such topic", where=name, hint=did_you_mean(name, self._topics))
        return self._topics[name]

    def topics(self) -> tuple[Topic[Any], ...]:
        """Return all topics in order of creation."""
        return tuple(self._topics.values())

    def skills(self) -> dict[str, type[Skill[Any]]]:
        """Return the services and actions by their addresses."""
        servers = {**self._services, **self._actions}
        return {address: server.skill for address, server in servers.items()}

    def command_topics(self) -> tuple[str, ...]:
        """Return the names of the command topics, sorted."""
        return tuple(sorted(topic.name for topic in self._topics.values() if topic.takes_commands))

    def advertise_service(
        self, skill: type[Q], handler: Callable[[Q], Any], *, namespace: str, commands: str = ""
    ) -> None:
        """Serve `skill` at `<namespace>/<skill_name>`; the handler may be synchronous or async.

        A service that `commands` a resource refuses other callers while a run holds that resource. A skill that is
        explained as missing there, see `explain_missing`, is left out.

        Raises:
            HandlerNotTyped: the handler lacks the skill's annotations.
            BusError: the address is already served.
        """
        address = self._free_address(skill, namespace)
        verify_handler(skill, handler, address)
        if not self._explanation(address):
            self._services[address] = _ServiceServer(skill, handler, commands)

    def advertise_action(
        self,
        skill: type[A],
        handler: Callable[[A, ActiveGoal[Any]], Awaitable[Any]],
        *,
        namespace: str,
        exclusive: str = "",
    ) -> None:
        """Serve the action `skill` at `<namespace>/<skill_name>`.

        Actions that share `exclusive` execute one goal at a time between them; a second goal is rejected,
        and the message names the active one. An idle goal, see `ActiveGoal.replaceable`, ends for it instead.
        A skill that is explained as missing there is left out.
        """
        address = self._free_address(skill, namespace)
        verify_handler(skill, handler, address)
        if not self._explanation(address):
            self._actions[address] = _ActionServer(skill, handler, exclusive or address)

    def explain_missing(self, namespace: str, reason: Callable[[str], str]) -> None:
        """Give the reason why a skill is not served at `namespace`: by its name, empty where there is none.

        Call it before the skills are advertised: those with a reason are left out then.
        """
        self._reasons[namespace] = reason

    def withdraw(self, namespace: str) -> None:
        """Remove all services and actions under a namespace, for example when a device disconnects."""
        for table in (self._services, self._actions):
            for address in [a for a in table if a == namespace or a.startswith(namespace + "/")]:
                del table[address]

    async def call(self, request: Service[R], *, to: str, holder: Holder = ANONYMOUS_HOLDER) -> R:
        """Call a service and return its response.

        Raises:
            NoSuchSkill: there is no such service.
            LeaseRefused: the service commands a resource held by another holder.
            SkillFailed: the handler failed, its error is the cause; or it took longer than services may.
        """
        address = request.address(to)
        server = self._services.get(address)
        if server is None:
            raise self._no_such_service(address)
        if server.commands:
            if request.ends_run:
                reason = f"{holder.run} called {address}, which ends the run that has {server.commands}"
                await self.leases.claim(server.commands, holder, reason=reason)
            self._end_idle_goals(server.commands, holder)
            self.leases.refuse_foreign(server.commands, holder)
        try:
            response = server.handler(request)
            if inspect.isawaitable(response):
                response = await (response if self._service_timeout_s is None else self._in_time(response))
            return cast("R", response)
        except FlexcellError:
            raise
        except _TookTooLong as error:
            raise SkillFailed(
                f"the service has not answered within {self._service_timeout_s:g} s",
                where=address,
                hint="see what it waits for, or set a longer `service_timeout_s` of the `bus` of the cell",
            ) from error
        except Exception as error:
            # A handler may raise anything; the caller gets one type of error with its cause.
            raise SkillFailed(f"the service raised {type(error).__name__}: {error}", where=address) from error

    async def _in_time(self, response: Awaitable[object]) -> object:
        limit = asyncio.timeout(self._service_timeout_s)
        try:
            async with limit:
                return await response
        except TimeoutError as error:
            # One of the handler itself is its own failure.
            raise _TookTooLong if limit.expired() else error from error

    def send_goal(
        self, goal: Action[R, F], *, to: str, holder: Holder = ANONYMOUS_HOLDER, goal_id: str = ""
    ) -> GoalHandle[R, F]:
        """Send a goal; returns at once, await `accepted` and `result` of the handle.

        The goal leases `to` for `holder` until it ends. An idle goal that gives way is cancelled, and this one begins
        at its end; an idle goal of a run gives way to goals of the same run only.

        Raises:
            NoSuchSkill: there is no such action.
            LeaseRefused: another holder commands the resource.
        """
        address = goal.address(to)
        server = self._actions.get(address)
        if server is None:
            raise self._no_such_service(address)
        self._end_idle_goals(to, holder, server.exclusive)
        self.leases.acquire((to,), holder)
        self._goal_count += 1
        active: ActiveGoal[Any] = ActiveGoal(goal_id or f"g{self._goal_count}", address, holder)
        task = self._loop.create_task(self._serve(server, goal, active, to), name=f"goal {active.id} {address}")
        handle: GoalHandle[Any, Any] = GoalHandle(active, task)
        self._goals[handle] = task
        task.add_done_callback(lambda _: self._goals.pop(handle, None))
        return handle

    async def _serve(
        self, server: _ActionServer, goal: Action[Any, Any], active: ActiveGoal[Any], to: str
    ) -> GoalEnd[Any]:
        while (other := self._running.get(server.exclusive)) is not None and other.was_replaced:
            await other.ended.wait()
        try:
            if other is not None:
                return await execute_goal(_rejecting_handler(other), goal, active)
            self._running[server.exclusive] = active
            return await execute_goal(server.handler, goal, active)
        finally:
            if self._running.get(server.exclusive) is active:
                del self._running[server.exclusive]
            active.ended.set()
            if not active.was_replaced:
                self.leases.release((to,), active.holder)
            if active.holder.run == ANONYMOUS_HOLDER.run and len(self.goals(ANONYMOUS_HOLDER.run)) <= 1:
                self.leases.release_run(ANONYMOUS_HOLDER.run)

    def _end_idle_goals(self, resource: str, holder: Holder, exclusive: str = "") -> None:
        """Cancel the idle goals that give way to `holder` on a resource, and release their leases at once."""
        root, running = _root_of(resource), self._running.get(exclusive)
        for handle in tuple(self._goals):
            is_running = running is not None and (running.id, running.address) == (handle.id, handle.address)
            # What a run has leased stays with it until it ends.
            is_foreign = handle.holder_run != holder.run and not handle.holder.branch
            if not handle.replaceable or not (is_running or (is_foreign and _root_of(handle.address) == root)):
                continue
            handle.replace()
            self.leases.release((handle.address.rpartition("/")[0],), handle.holder)
            if is_foreign and len(self.goals(handle.holder_run)) == 1:
                self.leases.release_run(handle.holder_run)

    def request_type(self, address: str) -> type[Skill[Any]]:
        """Return the request type of the skill at a full bus address; raises NoSuchSkill."""
        server = self._services.get(address) or self._actions.get(address)
        if server is None:
            raise self._no_such_service(address)
        return server.skill

    def listing(self) -> tuple[BusEntry, ...]:
        """Return everything on the bus: topics, services, actions, parameters, leases."""
        rows = [BusEntry("topic", t.name, t.kind.__name__, _traffic(t)) for t in self._topics.values()]
        rows += [BusEntry("service", a, s.skill.__name__, "") for a, s in self._services.items()]
        rows += [BusEntry("action", a, s.skill.__name__, self._busy(s.exclusive)) for a, s in self._actions.items()]
        rows += [
            BusEntry("parameter", p.name, type(p.value).__name__, repr(p.value)) for p in self.parameters.listing()
        ]
        rows += [BusEntry("lease", name, "Holder", holder) for name, holder in self.leases.listing()]
        return tuple(sorted(rows, key=lambda row: (row.kind, row.name)))

    def _unwatch_topics(self, callback: Callable[[Topic[Any]], None]) -> None:
        self._topic_watchers = tuple(known for known in self._topic_watchers if known is not callback)

    def _busy(self, exclusive: str) -> str:
        running = self._running.get(exclusive)
        return f"busy with {running.address} of {running.holder}" if running else ""

    def _free_address(self, skill: type[Skill[Any]], namespace: str) -> str:
        address = f"{namespace}/{skill.skill_name()}"
        if address in self._services or address in self._actions:
            raise BusError("this address is already served", where=address)
        return address

    def _explanation(self, address: str) -> str:
        namespace, _, skill = address.rpartition("/")
        return self._reasons[namespace](skill) if namespace in self._reasons else ""

    def _no_such_service(self, address: str) -> NoSuchSkill:
        reason = self._explanation(address)
        if reason:
            return NoSuchSkill(reason, where=address, hint="use another device, or simulate it with `driver: sim`")
        known = [*self._services, *self._actions]
        return NoSuchSkill("no such service", where=address, hint=did_you_mean(address, known))


def _rejecting_handler(other: ActiveGoal[Any]) -> Callable[[Any, ActiveGoal[Any]], Awaitable[Any]]:
    async def reject(_goal: object, handle: ActiveGoal[Any]) -> None:
        raise GoalRejected(
            f"busy with goal {other.id} of {other.holder} at {other.address}",
            where=handle.address,
            hint="wait for its end or cancel it",
        )

    return reject


def _root_of(address: str) -> str:
    return address.partition("/")[0]


def _traffic(topic: Topic[Any]) -> str:
    commands = ", takes commands" if topic.takes_commands else ""
    return f"{topic.rate_hz:.1f} Hz, {topic.subscriber_count} subscribers{commands}"
