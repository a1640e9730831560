"""Checks of a run: functions that read the recording of any engine, and yield faults.

Each reads its thresholds from ``Run.thresholds``. What is wrong in the description alone, before
the first timestep, is in ``model_checks``.
"""
