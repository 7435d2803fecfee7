"""Converts the `mechanism` of a tool document to that of the tool model, with the tool's names on the arm."""

from __future__ import annotations

from robots.model.folder.folder_document import (
    ClawSpec,
    LinkageGripperSpec,
    MagnetSpec,
    PadSpec,
    ParallelGripperSpec,
    SynergyHandSpec,
    TendonJoint,
)
from robots.model.tool_model import (
    ClawModel,
    GripperModel,
    LinkageModel,
    MagnetModel,
    Mechanism,
    PadBox,
    SynergyJoint,
    SynergyModel,
)


def mechanism_of(
    document: ParallelGripperSpec | LinkageGripperSpec | MagnetSpec | SynergyHandSpec | ClawSpec,
    *,
    name: str,
    prefix: str,
) -> Mechanism:
    """Return the mechanism of the tool `name`, with `prefix` before its link and joint names."""

    def pad(described: PadSpec) -> PadBox:
        return PadBox(link=prefix + described.link, xyz=described.xyz, size_m=described.size_m)

    def tendon(joint: TendonJoint) -> SynergyJoint:
        return SynergyJoint(
            name=prefix + joint.name,
            radius_m=joint.radius_m,
            stiffness_nm_rad=joint.stiffness_nm_rad,
            damping_nms_rad=joint.damping_nms_rad,
        )

    match document:
        case ParallelGripperSpec():
            return GripperModel(
                name=name,
                hand_link=prefix + document.hand_link,
                finger_joints=_two(prefix, document.finger_joints),
                finger_links=_two(prefix, document.finger_links),
                pads=(pad(document.pads[0]), pad(document.pads[1])),
                max_width_m=document.max_width_m,
                max_speed_m_s=document.max_speed_m_s,
                max_force_n=document.max_force_n,
                armature_kg=document.armature_kg,
            )
        case LinkageGripperSpec():
            return LinkageModel(
                driver=prefix + document.driver,
                followers=tuple((prefix + joint, factor) for joint, factor in document.followers.items()),
                finger_links=_two(prefix, document.finger_links),
                pads=(pad(document.pads[0]), pad(document.pads[1])),
                open_rad=document.open_rad,
                closed_rad=document.closed_rad,
                max_width_m=document.max_width_m,
                max_speed_m_s=document.max_speed_m_s,
                min_force_n=document.min_force_n,
                max_force_n=document.max_force_n,
                armature_kg_m2=document.armature_kg_m2,
            )
        case MagnetSpec():
            return MagnetModel(
                face=pad(document.face),
                max_force_n=document.max_force_n,
                reach_m=document.reach_m,
                max_payload_kg=document.max_payload_kg,
                switch_s=document.switch_s,
            )
        case SynergyHandSpec():
            return SynergyModel(
                palm_link=prefix + document.palm_link,
                fingers=tuple(tuple(prefix + link for link in finger) for finger in document.fingers),
                flexion=tuple(tendon(joint) for joint in document.flexion),
                passive=tuple(tendon(joint) for joint in document.passive),
                travel_m=document.travel_m,
                travel_speed_m_s=document.travel_speed_m_s,
                max_force_n=document.max_force_n,
            )
        case ClawSpec():
            return ClawModel(
                driver=prefix + document.driver,
                followers=tuple((prefix + joint, factor) for joint, factor in document.followers.items()),
                finger_links=_two(prefix, document.finger_links),
                pads=(pad(document.pads[0]), pad(document.pads[1])),
                open_rad=document.open_rad,
                closed_rad=document.closed_rad,
                servo_open_rad=document.servo_open_rad,
                servo_closed_rad=document.servo_closed_rad,
                max_width_m=document.max_width_m,
                max_speed_rad_s=document.max_speed_rad_s,
                max_effort_nm=document.max_effort_nm,
                armature_kg_m2=document.armature_kg_m2,
            )


def _two(prefix: str, names: tuple[str, str]) -> tuple[str, str]:
    return prefix + names[0], prefix + names[1]
