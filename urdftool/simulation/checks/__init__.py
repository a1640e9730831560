"""Checks of a run: functions that read its recording and yield faults, whatever the engine.

Each reads its thresholds from ``Run.thresholds``. What is wrong in the description alone, before
the first timestep, is in ``model_checks``.
"""
