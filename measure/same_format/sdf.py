"""Elements of SDF that are added to a model; an export to SDF keeps or reports each."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from lxml import etree

import urdftool as api

INERTIAL = """<inertial><mass>1</mass><inertia><ixx>.1</ixx><iyy>.1</iyy><izz>.1</izz></inertia>
</inertial>"""
BALL = "<geometry><sphere><radius>.1</radius></sphere></geometry>"
BASE = f"""<sdf version="1.9"><model name="m"><link name="a">{INERTIAL}
<collision name="c">{BALL}</collision><visual name="v">{BALL}</visual></link>
<link name="b"><pose>0 0 1 0 0 0</pose>{INERTIAL}</link>
<joint name="j" type="revolute"><parent>a</parent><child>b</child><axis><xyz>0 0 1</xyz></axis>
</joint></model></sdf>"""

ADDITIONS = (
    ("//model",
     '<static>true</static>'),
    ("//model",
     '<self_collide>true</self_collide>'),
    ("//model",
     '<allow_auto_disable>false</allow_auto_disable>'),
    ("//model",
     '<enable_wind>true</enable_wind>'),
    ("//model",
     '<frame name="f" attached_to="a"><pose>1 0 0 0 0 0</pose></frame>'),
    ("//model",
     '<gripper name="g"><grasp_check><detach_steps>40</detach_steps></grasp_check>'
     '<gripper_link>b</gripper_link><palm_link>a</palm_link></gripper>'),
    ("//model",
     '<plugin name="p" filename="libx.so"><rate>3</rate></plugin>'),
    ("//model",
     '<model name="n"><link name="z"/></model>'),
    ("//link[@name='a']",
     '<gravity>false</gravity>'),
    ("//link[@name='a']",
     '<enable_wind>true</enable_wind>'),
    ("//link[@name='a']",
     '<self_collide>true</self_collide>'),
    ("//link[@name='a']",
     '<kinematic>true</kinematic>'),
    ("//link[@name='a']",
     '<must_be_base_link>true</must_be_base_link>'),
    ("//link[@name='a']",
     '<velocity_decay><linear>.1</linear><angular>.2</angular></velocity_decay>'),
    ("//link[@name='a']",
     '<sensor name="s" type="imu"><update_rate>7</update_rate><always_on>true</always_on>'
     '<topic>t</topic><imu><angular_velocity><x><noise type="gaussian">'
     '<stddev>.1</stddev></noise></x></angular_velocity></imu></sensor>'),
    ("//link[@name='a']",
     '<sensor name="s" type="camera"><camera name="k">'
     '<horizontal_fov>1.2</horizontal_fov><image><width>30</width><height>20</height>'
     '<format>L8</format></image><clip><near>.2</near><far>9</far></clip><distortion>'
     '<k1>.1</k1></distortion></camera></sensor>'),
    ("//link[@name='a']",
     '<sensor name="s" type="gpu_lidar"><lidar><scan><horizontal><samples>9</samples>'
     '<min_angle>-1</min_angle><max_angle>1</max_angle></horizontal></scan><range>'
     '<min>.1</min><max>4</max></range></lidar></sensor>'),
    ("//link[@name='a']",
     '<sensor name="s" type="altimeter"><altimeter><vertical_position>'
     '<noise type="gaussian"><stddev>.1</stddev></noise></vertical_position></altimeter>'
     '</sensor>'),
    ("//link[@name='a']",
     '<sensor name="s" type="air_pressure"><air_pressure>'
     '<reference_altitude>3</reference_altitude></air_pressure></sensor>'),
    ("//link[@name='a']",
     '<sensor name="s" type="contact"><contact><collision>c</collision></contact></sensor>'),
    ("//link[@name='a']",
     '<sensor name="s" type="custom" gz:type="own" xmlns:gz="http://gz"><x>1</x></sensor>'),
    ("//link[@name='a']",
     '<light name="l" type="spot"><diffuse>1 0 0 1</diffuse><attenuation><range>3</range>'
     '</attenuation><spot><inner_angle>.1</inner_angle><outer_angle>.5</outer_angle>'
     '<falloff>1</falloff></spot></light>'),
    ("//link[@name='a']",
     '<projector name="p"><texture>x.png</texture><fov>.7</fov></projector>'),
    ("//link[@name='a']",
     '<audio_source><uri>x.mp3</uri></audio_source>'),
    ("//link[@name='a']",
     '<battery name="b"><voltage>12</voltage></battery>'),
    ("//link[@name='a']",
     '<particle_emitter name="e" type="point"><rate>3</rate></particle_emitter>'),
    ("//link[@name='a']",
     '<audio_sink/>'),
    ("//link[@name='a']/inertial",
     '<fluid_added_mass><xx>1</xx></fluid_added_mass>'),
    ("//link[@name='a']/inertial",
     '<density>300</density>'),
    ("//link[@name='a']/inertial",
     '<auto_inertia_params><x>1</x></auto_inertia_params>'),
    ("//joint/axis",
     '<dynamics><damping>.1</damping><friction>.2</friction>'
     '<spring_reference>.3</spring_reference><spring_stiffness>4</spring_stiffness>'
     '</dynamics>'),
    ("//joint/axis",
     '<limit><lower>-1</lower><upper>1</upper><effort>3</effort><velocity>4</velocity>'
     '<stiffness>1e5</stiffness><dissipation>2</dissipation></limit>'),
    ("//joint",
     '<physics><ode><cfm_damping>true</cfm_damping><limit><cfm>.1</cfm><erp>.3</erp>'
     '</limit><suspension><cfm>.1</cfm></suspension></ode></physics>'),
    ("//joint",
     '<sensor name="ft" type="force_torque"><force_torque><frame>parent</frame>'
     '<measure_direction>parent_to_child</measure_direction></force_torque></sensor>'),
    ("//joint",
     '<screw_thread_pitch>2</screw_thread_pitch>'),
    ("//joint",
     '<gearbox_ratio>2</gearbox_ratio>'),
    ("//joint/axis",
     '<mimic joint="j"><multiplier>1</multiplier><offset>0</offset>'
     '<reference>0</reference></mimic>'),
    ("//collision",
     '<laser_retro>3</laser_retro>'),
    ("//collision",
     '<max_contacts>3</max_contacts>'),
    ("//collision",
     '<surface><friction><ode><mu>.3</mu><mu2>.4</mu2><fdir1>1 0 0</fdir1>'
     '<slip1>.1</slip1></ode></friction></surface>'),
    ("//collision",
     '<surface><friction><torsional><coefficient>.3</coefficient>'
     '<patch_radius>.1</patch_radius></torsional></friction></surface>'),
    ("//collision",
     '<surface><friction><bullet><friction>.3</friction>'
     '<rolling_friction>.2</rolling_friction></bullet></friction></surface>'),
    ("//collision",
     '<surface><bounce><restitution_coefficient>.4</restitution_coefficient>'
     '<threshold>2</threshold></bounce></surface>'),
    ("//collision",
     '<surface><contact><ode><kp>1e5</kp><kd>3</kd><max_vel>.2</max_vel>'
     '<min_depth>.01</min_depth><soft_cfm>.1</soft_cfm></ode></contact></surface>'),
    ("//collision",
     '<surface><contact><collide_bitmask>3</collide_bitmask>'
     '<category_bitmask>1</category_bitmask></contact></surface>'),
    ("//collision",
     '<surface><soft_contact><dart><bone_attachment>3</bone_attachment></dart>'
     '</soft_contact></surface>'),
    ("//collision",
     '<density>300</density>'),
    ("//visual",
     '<cast_shadows>false</cast_shadows>'),
    ("//visual",
     '<laser_retro>3</laser_retro>'),
    ("//visual",
     '<transparency>.4</transparency>'),
    ("//visual",
     '<visibility_flags>3</visibility_flags>'),
    ("//visual",
     '<meta><layer>2</layer></meta>'),
    ("//visual",
     '<material><ambient>1 0 0 1</ambient><diffuse>0 1 0 1</diffuse>'
     '<specular>0 0 1 1</specular><emissive>.1 0 0 1</emissive><shininess>3</shininess>'
     '<lighting>false</lighting><double_sided>true</double_sided>'
     '<render_order>2</render_order></material>'),
    ("//visual",
     '<material><pbr><metal><roughness>.3</roughness><metalness>.4</metalness></metal>'
     '</pbr></material>'),
    ("//visual",
     '<material><script><uri>file://media/materials/scripts/gazebo.material</uri>'
     '<name>Own/Pattern</name></script></material>'),
    ("//visual",
     '<material><shader type="pixel"><normal_map>x</normal_map></shader></material>'),
    ("//visual",
     '<plugin name="p" filename="libv.so"><x>2</x></plugin>'),
)  # fmt: skip
"""Path of the parent, and the element."""


class Result(NamedTuple):
    """What became of an addition.

    Attributes:
        what: The element.
        missing: Values of it that the export does not have.
        codes: Codes of the losses that only the model with it has.
        differing: Rows of the proof that differ.
    """

    what: str
    missing: list[str]
    codes: list[str]
    differing: list[str]

    @property
    def verdict(self) -> str:
        """Return ``kept``, ``reported``, ``lost``, or ``proof fails``."""
        if self.differing:
            return "proof fails: " + ", ".join(self.differing)
        if not self.missing:
            return "kept"
        return "reported" if self.codes else "lost: " + ", ".join(self.missing)


Values = set[tuple[str, object]]


def measure_sdf(
    folder: Path, additions: tuple[tuple[str, str], ...] = ADDITIONS
) -> Iterator[Result]:
    """Yield the result of each addition to an SDF."""
    _, plain, _ = _export(BASE, folder)
    for path, xml in additions:
        root, element = etree.fromstring(BASE), etree.fromstring(xml)
        root.xpath(path)[0].append(element)
        values, losses, differing = _export(etree.tostring(root, encoding="unicode"), folder)
        missing = sorted({tag for tag, value in list_values(element) if (tag, value) not in values})
        codes = sorted({code for code, _ in losses - plain})
        yield Result(xml[:60], missing, codes, differing)


def _export(text: str, folder: Path) -> tuple[Values, set[tuple[str, str]], list[str]]:
    """Export a model; return the values in the export, its losses and the rows that differ."""
    source, made = folder / "source.sdf", folder / "made.sdf"
    source.write_text(text)
    written = api.export_sdf(api.load(source), made, force=True, verify=True, overwrite=True)
    differing = [check.name for check in written.checks if check.verdict == "differs"]
    losses = {(loss.code, loss.message) for loss in written.losses}
    return list_values(etree.fromstring(made.read_bytes())), losses, differing


def list_values(root: etree._Element) -> Values:
    """Return the texts and attributes of all elements, numbers as such."""
    found: Values = set()
    for element in root.iter(etree.Element):
        found.add((str(element.tag), _read((element.text or "").strip())))
        found |= {(f"{element.tag} {name}", _read(str(v))) for name, v in element.attrib.items()}
    return found


def _read(text: str) -> object:
    try:
        return tuple(map(float, text.split()))
    except ValueError:
        return {"true": (1.0,), "false": (0.0,)}.get(text, text)
