"""The real-time interface of ReconCell: datagrams to and from any arm with six joints, as server and as client.

The packets are those of appendices A and B of the ReconCell interfaces, docs/decisions/0089. It is never to be run
against the Simulink server of that project.
"""

from robots.reconcell.control_mode import ControlMode
from robots.reconcell.interface_options import InterfaceOptions
from robots.reconcell.packet_errors import PacketRefused
from robots.reconcell.reconcell_client import ReconcellClient
from robots.reconcell.reconcell_server import ReconcellServer

__all__ = ["ControlMode", "InterfaceOptions", "PacketRefused", "ReconcellClient", "ReconcellServer"]
