"""Physics engines, one package each, which ``registry`` finds by name.

Code outside of an engine's package does not depend on the engine: differences are in
:class:`base.Capabilities`. An engine is an :class:`base.Engine` called ``ENGINE`` in a
package of its own, and a line in ``registry.REGISTRY``.
"""
