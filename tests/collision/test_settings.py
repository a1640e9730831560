"""Settings of collision geometry."""

from urdftool.collision.settings import QUALITIES, Settings


def test_a_quality_sets_its_limits():
    tight = Settings.from_quality("tight", max_vertices=24)
    assert (tight.quality, tight.max_error, tight.most) == (
        "tight",
        QUALITIES["tight"].max_error,
        32,
    )
    assert tight.max_vertices == 24
    assert Settings.from_quality("fast", max_error=0.02, max_hulls=7).max_error == 0.02
    assert Settings.from_quality("fast", max_hulls=7).most == 7
