"""Small MJCF and USD files that would need all memory, or would not end."""

_BODY = '<body name="b"><joint name="j"/><geom size=".1"/></body>'


def mjcf(world="", before=""):
    return f"<mujoco>{before}<worldbody>{_BODY}{world}</worldbody></mujoco>"


def _nest(text, times, inside):
    for _ in range(times):
        inside = text.format(inside)
    return inside


_MESH = '<geom type="mesh" mesh="m"/>'
_FLEX = (
    '<body name="f"><flexcomp name="f" type="grid" count="1000 1000 1000" spacing="1 1 1"/></body>'
)
_CABLE = (
    '<body name="f"><composite type="cable" count="1000000 1 1" size="1" curve="l 0 0"/></body>'
)
_TEXTURE = '<asset><texture name="t" type="2d" builtin="checker" width="{0}" height="{0}"/></asset>'

COUNTED_MJCF = {
    "flexcomp": mjcf(_FLEX),
    "composite": mjcf(_CABLE),
    "replicate": mjcf('<replicate count="1000000"><body/></replicate>'),
    "nested": mjcf(_nest('<replicate count="100">{}</replicate>', 4, "<body/>")),
}
"""Refused for the number of their elements, before MuJoCo reads them."""

LARGE_MJCF = {
    "texture": mjcf(before=_TEXTURE.format(100_000)),
    "textures": mjcf(
        before="".join(_TEXTURE.format(8000).replace('"t"', f'"t{n}"') for n in range(20))
    ),
    "hfield": mjcf(
        '<geom type="hfield" hfield="h"/>',
        '<asset><hfield name="h" nrow="40000" ncol="40000" size="1 1 1 1"/></asset>',
    ),
    "user values": mjcf(before='<size nuser_geom="1000000000"/>'),
    "mesh": mjcf(_MESH, '<asset><mesh name="m" builtin="supersphere" params="30000 1 1"/></asset>'),
    "sensors": mjcf(
        before="<sensor>"
        + "".join(f'<user name="s{n}" dim="1000000"/>' for n in range(2000))
        + "</sensor>"
    ),
}
"""Ended by the limit of memory."""

SLOW_MJCF = {
    "keyframes": mjcf(before='<size nkey="1000000000"/>'),
    "bodies": mjcf(
        '<replicate count="12000" offset="1 0 0"><body><geom size=".1"/></body></replicate>'
    ),
    "length range": mjcf(
        before='<compiler><lengthrange mode="all" inttotal="1e9" timestep="1e-9"/></compiler>'
        '<actuator><muscle joint="j"/></actuator>'
    ),
}
"""Ended by the limit of processor time."""


def write_attached(folder):
    """Models that attach the next ten times each; gives the first."""
    for level in range(10):
        attach = "".join(f'<attach model="n" body="b" prefix="p{n}_"/>' for n in range(10))
        asset = f'<asset><model name="n" file="a{level + 1}.xml"/></asset>'
        text = mjcf(before=asset).replace("<geom", f"{attach}<geom") if level < 9 else mjcf()
        (folder / f"a{level}.xml").write_text(text)
    return folder / "a0.xml"


_HEAD = '#usda 1.0\n(\n    defaultPrim = "r"\n)\n'
_RIGID = """def Xform "body" (
    prepend apiSchemas = ["PhysicsRigidBodyAPI", "PhysicsMassAPI"]
)
{
    float physics:mass = 1
}
"""


def _prim(name, inside="", about=""):
    return f'def Xform "{name}" (\n{about}\n)\n{{\n{inside}}}\n'


def _levels(arc, about=""):
    """Ten levels of prims, each of which has the next ten times."""
    parts = []
    for level in range(10):
        children = (_prim(f"c{n}", about=f"{about}\n{arc.format(level + 1)}") for n in range(10))
        inside = "".join(children) if level < 9 else _RIGID
        parts.append(_prim(f"l{level}" if level else "r", inside))
    return _HEAD + "".join(parts)


def _make_variants():
    names = [f"v{n}" for n in range(5)]
    chosen = "\n".join(f'string {name} = "a"' for name in names)
    listed = ", ".join(f'"{name}"' for name in names)
    children = "".join(_prim(f"c{n}", about="references = </l1>") for n in range(10))
    sets = "".join(f'variantSet "{name}" = {{\n"a" {{\n{children}}}\n}}\n' for name in names)
    about = f"variantSets = [{listed}]\nvariants = {{\n{chosen}\n}}"
    levels = _levels("references = </l{}>").partition('def Xform "l1"')
    return _HEAD + _prim("r", _RIGID + sets, about) + levels[1] + levels[2]


COUNTED_USD = {
    "references": _levels("references = </l{}>"),
    "instances": _levels("references = </l{}>", "instanceable = true"),
    "payloads": _levels("payload = </l{}>"),
    "inherits": _levels("inherits = </l{}>"),
    "specializes": _levels("specializes = </l{}>"),
    "variants": _make_variants(),
    "classes": _HEAD
    + "".join(
        _prim(
            f"k{n}", _prim("q"), f"inherits = [{', '.join(f'</k{m}>' for m in range(n + 1, 18))}]"
        )
        for n in range(17)
    )
    + _prim("k17")
    + _prim("r", _RIGID, "inherits = </k0>"),
}
"""Refused for the number of their prims, before OpenUSD composes them."""


def write_layers(folder):
    """Layers that refer to the next ten times each; gives the first."""
    for level in range(10):
        children = (_prim(f"c{n}", about=f"references = @./x{level + 1}.usda@") for n in range(10))
        inside = "".join(children) if level < 9 else _RIGID
        (folder / f"x{level}.usda").write_text(_HEAD + _prim("r", inside))
    return folder / "x0.usda"


def write_arrays(folder):
    """A binary stage of 200 kB with a mesh of 60 million triangles."""
    from pxr import Usd, UsdGeom, Vt

    path = folder / "arrays.usdc"
    (folder / "start.usda").write_text(_HEAD + _prim("r", _RIGID))
    stage = Usd.Stage.Open(str(folder / "start.usda"))
    mesh = UsdGeom.Mesh.Define(stage, "/r/body/mesh")
    mesh.CreatePointsAttr(Vt.Vec3fArray(3))
    mesh.CreateFaceVertexCountsAttr(Vt.IntArray(60_000_000, 3))
    mesh.CreateFaceVertexIndicesAttr(Vt.IntArray(180_000_000, 1))
    stage.Export(str(path))
    return path


def write_instancer(folder):
    """A binary stage with a point instancer of 100 million instances."""
    from pxr import Usd, UsdGeom, Vt

    path = folder / "instancer.usdc"
    (folder / "start.usda").write_text(_HEAD + _prim("r", _RIGID))
    stage = Usd.Stage.Open(str(folder / "start.usda"))
    instancer = UsdGeom.PointInstancer.Define(stage, "/r/body/many")
    instancer.CreateProtoIndicesAttr(Vt.IntArray(100_000_000))
    stage.Export(str(path))
    return path


def write_bodies(folder):
    """A stage of 20,000 bodies."""
    bodies = "".join(_RIGID.replace('"body"', f'"b{n}"') for n in range(20_000))
    path = folder / "bodies.usda"
    path.write_text(_HEAD + _prim("r", bodies))
    return path


def make_reference(path):
    """A stage of one body that refers to a layer."""
    return _HEAD + _prim("r", _RIGID, f"references = @./{path}@")


def make_variants_of(name, variants):
    """A stage of two prims with a set of variants, each with a number of prims."""
    parts = (
        f'"{one}" {{\n{"".join(_prim(f"c{n}") for n in range(count))}}}\n'
        for one, count in variants.items()
    )
    inside = f'{_prim("x")}variantSet "{name}" = {{\n{"".join(parts)}}}\n'
    return _HEAD + _prim("r", inside, f'variantSets = ["{name}"]')
