"""Physics engines: a package each, which ``registry`` finds by its name.

Nothing outside an engine's package knows which engine runs: what engines do differently is in
their :class:`base.Capabilities`. An engine is an :class:`base.Engine` called ``ENGINE`` in a
package of its own, and a line in ``registry.REGISTRY``.
"""
