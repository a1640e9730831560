"""Export of an MJCF to MJCF: MuJoCo must compute the same, or the difference is reported."""

import numpy as np
import pytest

import urdftool as api

pytestmark = pytest.mark.library("mujoco")

BODIES = """<body name="e"><joint name="limited" axis="0 0 1" actuatorfrcrange="-2 2"/>
<geom size=".1" pos="3 0 0"/></body>
<body name="a"><joint name="j" pos="0.1 0 0"/><geom size=".1" pos=".2 .1 0"/>
<body name="b" pos="0.3 0 0"><joint name="k" pos="0 0.2 0" axis="0 1 0"/><geom size=".1"/></body>
</body><body name="hand" mocap="true" pos="1 0 0"><geom size=".1" mass="1"/></body>
<body name="c" pos="0 0 1"><joint name="l" pos="0 0.2 0.1" axis="1 1 0"/><geom size=".1"/></body>"""
ELEMENTS = {
    "weld to a moved target": '<equality><weld body1="a" body2="hand"/></equality>',
    "connect": '<equality><connect body1="b" body2="c" anchor="0.1 0.2 0.3"/></equality>',
    "weld with a pose": '<equality><weld body1="c" body2="b" anchor="0.3 0 0" '
    'relpose="0.1 0.2 0.3 1 0.2 0 0"/></equality>',
    "weld that is not active": '<equality><weld body1="c" body2="b" active="false"/></equality>',
    "position of a body": '<sensor><framepos objtype="xbody" objname="a"/></sensor>',
    "position of a center of mass": '<sensor><framepos objtype="body" objname="a"/></sensor>',
    "force limit of a joint below that of its servo": '<actuator><position joint="limited" kp="9" '
    'forcerange="-5 5" ctrlrange="-9 9"/></actuator>',
    "relative velocity": '<sensor><framelinvel name="v" objtype="xbody" objname="b" '
    'reftype="xbody" refname="a"/></sensor>',
}


@pytest.mark.parametrize("name", ELEMENTS)
def test_an_element_at_a_moved_frame_is_the_same(tmp_path, name):
    import mujoco

    source = tmp_path / "m.xml"
    text = f'<mujoco model="m"><worldbody>{BODIES}</worldbody>{ELEMENTS[name]}</mujoco>'
    source.write_text(text)
    written = api.export_mjcf(api.load(source), tmp_path / "out.xml", verify=True)
    assert [check.name for check in written.checks if check.verdict == "differs"] == []
    assert "lossy-loop" not in {loss.code for loss in written.losses}
    models = [mujoco.MjModel.from_xml_path(str(tmp_path / n)) for n in ("m.xml", "out.xml")]
    assert [model.nmocap for model in models] == [1, 1]
    for seed in range(3):
        one, two = (_compute(mujoco, model, seed) for model in models)
        np.testing.assert_allclose(one, two, atol=1e-9)


def _compute(mujoco, model, seed):
    """Errors of constraints, accelerations and sensors at a random state."""
    data, random = mujoco.MjData(model), np.random.default_rng(seed)
    data.qpos[:], data.qvel[:] = random.normal(0, 0.5, (2, model.nq))
    data.ctrl[:] = 9
    mujoco.mj_forward(model, data)
    return np.concatenate([data.efc_pos, data.qacc / 100, data.sensordata])


REPORTED = {
    "unread-base-dynamics": '<body name="b" pos="1 0 0"><freejoint/><geom size=".1"/></body>'
    '<body name="c" pos="2 0 0"><joint type="free" damping="1"/><geom size=".1"/></body>',
    "lossy-overlap": '<body name="f"><geom type="plane" size="1 1 1"/><geom size=".1"/></body>'
    '<body name="c"><joint/><geom size=".1" pos="0.01 0 0"/></body>',
}


@pytest.mark.parametrize("code", REPORTED)
def test_a_difference_is_reported(tmp_path, code):
    source = tmp_path / "m.xml"
    source.write_text(f'<mujoco model="m"><worldbody>{REPORTED[code]}</worldbody></mujoco>')
    written = api.export_mjcf(api.load(source), force=True)
    assert code in {loss.code for loss in written.losses}


def test_settings_that_attached_models_keep_from_being_copied_are_reported(tmp_path):
    (tmp_path / "part.xml").write_text(
        f'<mujoco model="p"><worldbody>{BODIES}</worldbody>'
        '<equality><weld body1="b" active="false"/></equality></mujoco>'
    )
    source = tmp_path / "m.xml"
    source.write_text(
        '<mujoco model="m"><asset><model name="p" file="part.xml"/></asset><worldbody><body '
        'name="t"><joint/><geom size=".1"/></body><frame><attach model="p" body="b" prefix="x_"/>'
        '</frame></worldbody><equality><weld body1="t" body2="x_b" solref="0.03 1"/></equality>'
        "</mujoco>"
    )
    codes = {loss.code for loss in api.export_mjcf(api.load(source), force=True).losses}
    assert "unread-created" in codes
