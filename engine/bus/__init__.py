"""The skill bus: typed topics, services, preemptable actions, parameters and leases."""

from engine.bus.action import ActiveGoal, GoalHandle
from engine.bus.bus import ANONYMOUS_HOLDER, BusEntry, SkillBus
from engine.bus.handler_signature import expected_signature
from engine.bus.json_bus import JsonBus
from engine.bus.lease import Holder, Lease, LeaseTable
from engine.bus.parameter_server import BusParameter, ParameterServer
from engine.bus.plain_requests import publish_value, typed_action, typed_service
from engine.bus.topic import Subscription, Topic, TopicStream
from engine.skills.goal_end import GoalEnd, GoalStatus

__all__ = [
    "ANONYMOUS_HOLDER",
    "ActiveGoal",
    "BusEntry",
    "BusParameter",
    "GoalEnd",
    "GoalHandle",
    "GoalStatus",
    "Holder",
    "JsonBus",
    "Lease",
    "LeaseTable",
    "ParameterServer",
    "SkillBus",
    "Subscription",
    "Topic",
    "TopicStream",
    "expected_signature",
    "publish_value",
    "typed_action",
    "typed_service",
]
