"""Teaching by the Helping Hand (RCY 7.1): buttons trigger captures of robot states, which become named entries.

Depends on the bus and its skills only: triggers come from any topic, robots provide their usual skills, the store
takes what is saved.
"""

from engine.teaching.capture_buffer import CaptureBuffer
from engine.teaching.edge_detection import ButtonEdge, EdgeDetector
from engine.teaching.helping_hand import HelpingHand, guidable_robots
from engine.teaching.teach_document import TeachDocument, load_triggers

__all__ = [
    "ButtonEdge",
    "CaptureBuffer",
    "EdgeDetector",
    "HelpingHand",
    "TeachDocument",
    "guidable_robots",
    "load_triggers",
]
