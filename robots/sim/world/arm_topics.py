"""The topics of one arm of a world: joints, also in the convention of the robot's controller, and forces."""

from __future__ import annotations

from engine.bus import SkillBus
from engine.messages import ExternalTorque, JointState, Wrench
from robots.model.joint_map import JointMap
from robots.port.wrench import to_wrench
from robots.sim.host.world_host import WorldHost
from robots.sim.loop.snapshot import ArmSummary, SimSnapshot
from robots.sim.world.tool_topics import StateTopic, ToolTopic


def arm_topics(bus: SkillBus, host: WorldHost, arm: ArmSummary, joint_map: JointMap) -> tuple[ToolTopic, ...]:
    """Return the topics of an arm: `<arm>/joint_state`, `<arm>/wrench`, `<arm>/external`, `<arm>/device_joints`.

    The wrench is that of the environment on the tool at the tool centre point, in world axes. The
    last topic, the joints as the robot's controller shows them, exists only where they differ.
    """

    def wrench(snapshot: SimSnapshot) -> Wrench:
        return to_wrench(snapshot.arm(arm.name).wrench)

    def joint_state(snapshot: SimSnapshot) -> JointState:
        sample = snapshot.arm(arm.name)
        return JointState(
            time_s=sample.time_s,
            names=arm.joints,
            position_rad=tuple(sample.position_rad.tolist()),
            velocity_rad_s=tuple(sample.velocity_rad_s.tolist()),
            effort_nm=tuple(sample.effort_nm.tolist()),
        )

    def external(snapshot: SimSnapshot) -> ExternalTorque:
        sample = snapshot.arm(arm.name)
        return ExternalTorque(time_s=sample.time_s, names=arm.joints, torque_nm=tuple(sample.external_nm.tolist()))

    def device_joints(snapshot: SimSnapshot) -> JointState:
        sample = snapshot.arm(arm.name)
        return JointState(
            time_s=sample.time_s,
            names=arm.joints,
            position_rad=tuple(joint_map.to_device(sample.position_rad).tolist()),
            velocity_rad_s=tuple(joint_map.rates_to_device(sample.velocity_rad_s).tolist()),
            effort_nm=tuple(joint_map.efforts_to_device(sample.effort_nm).tolist()),
        )

    device: tuple[ToolTopic, ...] = ()
    if not joint_map.is_identity:
        device = (StateTopic(bus.topic(f"{arm.name}/device_joints", JointState), host, device_joints),)
    return (
        StateTopic(bus.topic(f"{arm.name}/joint_state", JointState), host, joint_state),
        StateTopic(bus.topic(f"{arm.name}/wrench", Wrench), host, wrench),
        StateTopic(bus.topic(f"{arm.name}/external", ExternalTorque), host, external),
        *device,
    )
