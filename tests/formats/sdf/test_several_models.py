"""One of several models of an SDF file, by ``-r NAME``."""

import pytest

import urdftool as api
from urdftool.errors import ConfigError, ModelError

ARM = """<model name="{}"><link name="a"/><link name="b"/><joint name="{}" type="revolute">
<parent>a</parent><child>b</child><axis><xyz>0 0 1</xyz></axis></joint></model>"""


@pytest.fixture
def world(tmp_path):
    path = tmp_path / "two.world"
    models = "\n".join(ARM.format(name, f"{name}_joint") for name in ("arm", "cart"))
    path.write_text(f'<sdf version="1.9"><world name="w">{models}</world></sdf>')
    return path


@pytest.mark.parametrize(("name", "joint"), [("", "arm_joint"), ("cart", "cart_joint")])
def test_the_model_is_chosen(world, name, joint):
    robot = api.load(world, name=name)
    assert list(robot.joint) == [joint]
    (loss,) = (loss for loss in robot.unread if loss.code == "unread-model")
    assert loss.data["names"] == [{"": "cart", "cart": "arm"}[name]]


def test_an_unknown_name_is_refused(world, tmp_path):
    with pytest.raises(ModelError, match="no model 'carts'; it has arm, cart; did you mean 'cart'"):
        api.load(world, name="carts")
    (tmp_path / "a.urdf").write_text('<robot name="a"><link name="l"/></robot>')
    with pytest.raises(ConfigError, match="a URDF has one robot"):
        api.load(tmp_path / "a.urdf", name="a")


def test_on_the_command_line(world, urdftool):
    done = urdftool("info", str(world), "-r", "cart")
    assert done.code == 0
    assert "cart" in done.out.splitlines()[0]
    done = urdftool("verify", str(world), "-r", "cart", str(world), "-r", "arm", "--only", "mass")
    assert done.code == 0
    assert urdftool("info", str(world), "-r", "none").code == 2
