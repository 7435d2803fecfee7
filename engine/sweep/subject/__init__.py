"""What all runs of a sweep have in common: documents, files and versions, and the cell as one run varies it.

`sweep_subject` loads and checks it, and tells versions apart; `subject_files` names the files that a machine needs.
"""
