"""Language server: checks and knowledge of robot descriptions in an editor.

``protocol.py`` talks to the editor; ``worker.py`` is a second process that is kept warm, expands,
checks and answers questions, and is killed when it does not answer.
"""
