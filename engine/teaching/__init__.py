"""Teaching by the Helping Hand (RCY 7.1): buttons trigger captures of where robots are, which become named entries.

Knows the bus and its skills only: triggers come from any topic, robots answer their usual skills, the store
takes what is saved.
"""

from engine.teaching.buffer import CaptureBuffer
from engine.teaching.document import TeachDocument, load_triggers
from engine.teaching.edges import Edge, EdgeDetector
from engine.teaching.helping_hand import HelpingHand, teachable

__all__ = ["CaptureBuffer", "Edge", "EdgeDetector", "HelpingHand", "TeachDocument", "load_triggers", "teachable"]
