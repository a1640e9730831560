"""What readers do with the defects that rules name: run, recorded, and compared with the sentences.

``fixtures/effects/FAMILY.yaml`` says of every sentence in the ``effects=`` of a rule how it is
known: by runs of a reader on a minimal robot, each with what is expected of it, or from the source
of the reader. ``python -m tests.effects --write`` runs the readers that are installed, writes what
they did to ``fixtures/effects/runs/RULE.json`` with the versions in ``readers.json``, and makes
``urdftool/rules/effect_sources.json``, which rule pages quote.
"""
