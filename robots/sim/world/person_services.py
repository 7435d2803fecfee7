"""The services of the people of a simulated cell: reach, withdraw, count contacts."""

from __future__ import annotations

import numpy as np

from engine.bus import SkillBus
from engine.errors import SkillFailed
from engine.messages import Vector3
from engine.skills.people import ContactCount, CountContacts, Reach, ReachResult, Withdraw
from engine.wording import did_you_mean
from robots.port import Array
from robots.scene.sim_scene import PersonBody
from robots.sim.commands.world_commands import MovePersonHand
from robots.sim.host.world_host import WorldHost
from robots.sim.people.hand_trajectory import HandMotion, plan_hand_trajectory
from robots.sim.people.person_report import PersonSample
from robots.sim.physics.limb import Limb


class PersonServices:
    """Rejects requests that an arm cannot execute, and sends the others to the world."""

    def __init__(self, world: str, people: tuple[PersonBody, ...], host: WorldHost) -> None:
        self._world = world
        self._people = {person.name: person for person in people}
        self._host = host

    def register(self, bus: SkillBus) -> None:
        """Advertise the services if there are people."""
        if not self._people:
            return
        bus.advertise_service(Reach, self.reach, namespace=self._world)
        bus.advertise_service(Withdraw, self.withdraw, namespace=self._world)
        bus.advertise_service(CountContacts, self.count_contacts, namespace=self._world)

    async def reach(self, request: Reach) -> ReachResult:
        """Send a hand to a point; raises SkillFailed if it is unreachable, RobotError when the world is lost."""
        person = self._person(request.person)
        arrives_in_s = self._look(person, request.hand_m, request.speed_m_s, and_back=request.stay_s is not None)
        return self._send(request, arrives_in_s)

    async def withdraw(self, request: Withdraw) -> ReachResult:
        """Send a hand back to rest; raises as `reach` does."""
        person = self._person(request.person)
        arrives_in_s = self._look(person, person.hand_rests, request.speed_m_s, and_back=False)
        back = Reach(person=person.name, hand_m=person.hand_rests, speed_m_s=request.speed_m_s)
        return self._send(back, arrives_in_s)

    async def count_contacts(self, request: CountContacts) -> ContactCount:
        """Return the contact count of the physics."""
        return self._sample(self._person(request.person)).count

    def _send(self, reach: Reach, arrives_in_s: float) -> ReachResult:
        self._host.send(MovePersonHand(reach=reach))
        return ReachResult(person=reach.person, hand_m=reach.hand_m, arrives_in_s=arrives_in_s)

    def _look(self, person: PersonBody, goal: Vector3, speed_m_s: float, *, and_back: bool) -> float:
        """Return the duration of the motion; raises SkillFailed if it is impossible."""
        limb, place = Limb(person), np.array(goal)
        least_m, greatest_m = person.reach_m
        away_m = limb.away_m(place)
        if not least_m <= away_m <= greatest_m:
            raise SkillFailed(
                f"{person.name} cannot reach {_written(goal)}: it is {away_m:.3f} m from the shoulder, "
                f"reachable are {least_m:.3f} to {greatest_m:.3f} m",
                where=self._world,
                hint=f"the shoulder is at {_written(person.shoulder)}",
            )
        trajectory = plan_hand_trajectory(self._sample(person).hand, place, speed_m_s=speed_m_s)
        paths = [trajectory.places()]
        if and_back:
            there = HandMotion(xyz=place, velocity=np.zeros(3))
            paths.append(plan_hand_trajectory(there, np.array(person.hand_rests), speed_m_s=speed_m_s).places())
        if any(_through(places, person, limb) for places in paths):
            raise SkillFailed(
                f"the path of the hand of {person.name} to {_written(goal)} passes through the shoulder",
                where=self._world,
                hint="let it reach a point beside the shoulder first",
            )
        return trajectory.duration_s

    def _sample(self, person: PersonBody) -> PersonSample:
        return self._host.snapshot().person(person.name)

    def _person(self, name: str) -> PersonBody:
        if name not in self._people:
            raise SkillFailed(
                f"there is no person {name}", where=self._world, hint=did_you_mean(name, tuple(self._people))
            )
        return self._people[name]


def _through(places: Array, person: PersonBody, limb: Limb) -> bool:
    least_m = person.reach_m[0]
    return any(limb.away_m(place) < least_m * 0.999 for place in places)


def _written(xyz: Vector3) -> str:
    return f"({', '.join(f'{value:.3f}' for value in xyz)})"
