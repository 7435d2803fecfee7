"""The engine: documents, runs, bus, journal and store; knows no robot and no browser.

Importing it has every module of ours make its message and document types ready as it is imported;
two threads that did so at once would end the process, see `engine.type_preparation`.
"""

from engine.type_preparation import prepare_on_import

prepare_on_import("engine", "states", "robots", "editor_web", "behaviors")
