"""What commands print and write, recorded before a change and compared after it.

    make record                    # the commands of the work tree, into build/record
    git switch …                   # or: edit
    make compare                   # record again into build/record-now, and compare

``python -m measure.record record DIR [--program ROOT] [--only WORD]`` runs some 60 command lines
over the fixtures, example-robot-data and pybullet_data and stores the exit code, both streams and
every file written. ``python -m measure.record compare OLD NEW [--only WORD]`` lists differences:
first without what is written for people (messages, hints, effects), then that alone.
"""
