"""Parameter types of the states for the bus."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

TopicName = Annotated[
    str,
    Meta(
        min_length=1,
        description="Topic of the bus, such as operator/key or left/joint_state",
        extra_json_schema={"cell_name": "bus_topic"},
    ),
]
CellTopicName = Annotated[
    str, Meta(min_length=1, description="Topic that the cell declares", extra_json_schema={"cell_name": "topic"})
]
SkillAddress = Annotated[
    str,
    Meta(
        pattern="^[^/]+(/[^/]+)+$",
        description="Address on the bus, such as left/forward_kinematics; `flexcell bus list` shows them",
        extra_json_schema={"cell_name": "skill"},
    ),
]
Fields = Annotated[dict[str, object], Meta(description="Its fields by name")]
MessageCondition = Annotated[
    str,
    Meta(
        description="Expression over `message`, without the braces: message.value == 'start'. Empty: any message",
    ),
]


def split_address(address: str) -> tuple[str, str]:
    """Return the namespace and the name of a skill's address."""
    namespace, _, name = address.rpartition("/")
    return namespace, name
