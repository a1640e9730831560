"""Is what was written the same robot? Read back and computed anew, with nothing of the exporter.

``source`` and ``reader`` make a ``Mechanism`` of the robot and of the written file, ``dynamics``
has the algebra for both, ``compare`` the checks, ``loader`` asks Gazebo's own reader.
"""
