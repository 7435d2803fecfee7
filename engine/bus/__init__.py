"""The skill bus: typed topics, services, preemptable actions, parameters and leases."""

from engine.bus.action import ActiveGoal, GoalEnd, GoalHandle, GoalStatus
from engine.bus.bus import NOBODY, BusEntry, SkillBus
from engine.bus.handler import expected_signature
from engine.bus.lease import Holder, LeaseTable
from engine.bus.parameter import Parameter, ParameterServer
from engine.bus.topic import Stream, Subscription, Topic

__all__ = [
    "NOBODY",
    "ActiveGoal",
    "BusEntry",
    "GoalEnd",
    "GoalHandle",
    "GoalStatus",
    "Holder",
    "LeaseTable",
    "Parameter",
    "ParameterServer",
    "SkillBus",
    "Stream",
    "Subscription",
    "Topic",
    "expected_signature",
]
