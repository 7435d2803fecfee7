"""Fault injection: a port between a run and the bus that injects the faults of a document into requests.

`FaultPort(BusPort(bus), load_faults(file), clock=bus.clock, seed=seed)` is passed to the run as its
`skills`. `engine.document.faults` defines the document.
"""

from engine.document.faults import Fault, Faults, FaultsDocument, load_faults, parse_faults
from engine.faults.fault_port import FaultPort

__all__ = ["Fault", "FaultPort", "Faults", "FaultsDocument", "load_faults", "parse_faults"]
