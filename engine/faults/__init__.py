"""Fault injection: a port between a run and its surroundings that lets requests go wrong as a document says.

`FaultPort(BusPort(bus), load_faults(file), clock=bus.clock, seed=seed)` is given to the run as its
`skills`. The document is described in `engine.document.faults`.
"""

from engine.document.faults import Fault, Faults, FaultsDocument, load_faults, parse_faults
from engine.faults.fault_port import FaultPort

__all__ = ["Fault", "FaultPort", "Faults", "FaultsDocument", "load_faults", "parse_faults"]
