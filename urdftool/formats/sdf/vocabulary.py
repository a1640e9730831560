"""SDF elements that a ``<gazebo>`` block may hold, with their children.

Readers ignore unknown elements; strict ones reject the file.
"""

from __future__ import annotations

_CHILDREN = {
    "air_pressure": "pressure reference_altitude",
    "altimeter": "vertical_position vertical_velocity",
    "angular_velocity": "x y z",
    "attenuation": "constant linear quadratic range",
    "audio_source": "contact gain loop pitch pose uri",
    "axis": "dynamics initial_position limit mimic xyz",
    "axis2": "dynamics initial_position limit mimic xyz",
    "battery": "voltage",
    "blend": "fade_dist min_height",
    "bounce": "restitution_coefficient threshold",
    "box": "size",
    "bullet": "fdir1 friction friction2 kd kp rolling_friction soft_cfm soft_erp split_impulse "
    "split_impulse_penetration_threshold",
    "camera": "box_type camera_info_topic clip depth_camera distortion horizontal_fov image lens "
    "noise optical_frame_id pose save segmentation_type trigger_topic triggered "
    "visibility_mask",
    "capsule": "length radius",
    "clip": "far near",
    "collision": "auto_inertia_params density geometry laser_retro max_contacts pose surface",
    "cone": "length radius",
    "contact": "bullet category_bitmask collide_bitmask collide_without_contact "
    "collide_without_contact_bitmask collision elastic_modulus ode poissons_ratio topic",
    "convex_decomposition": "max_convex_hulls voxel_resolution",
    "custom_function": "c1 c2 c3 f fun",
    "cylinder": "length radius",
    "dart": "bone_attachment damping flesh_mass_fraction stiffness",
    "depth_camera": "clip output",
    "distortion": "center k1 k2 k3 p1 p2",
    "dynamics": "damping friction spring_reference spring_stiffness",
    "ellipsoid": "radii",
    "force": "x y z",
    "force_torque": "force frame measure_direction torque",
    "frame": "pose",
    "friction": "bullet ode torsional",
    "geometry": "box capsule cone cylinder ellipsoid empty heightmap image mesh plane polyline "
    "sphere "
    "box capsule cone cylinder ellipsoid empty heightmap image mesh plane polyline sphere",
    "gps": "position_sensing velocity_sensing",
    "grasp_check": "attach_steps detach_steps min_contact_count",
    "gripper": "grasp_check gripper_link palm_link",
    "heightmap": "blend pos sampling size texture uri use_terrain_paging",
    "horizontal": "max_angle min_angle noise resolution samples",
    "image": "format granularity height scale threshold uri width",
    "imu": "angular_velocity enable_orientation linear_acceleration orientation_reference_frame",
    "inertia": "ixx ixy ixz iyy iyz izz",
    "inertial": "auto_inertia_params density fluid_added_mass inertia mass pose",
    "intrinsics": "cx cy fx fy s",
    "joint": "axis axis2 child gearbox_ratio gearbox_reference_body parent physics plugin pose "
    "sensor thread_pitch",
    "lens": "custom_function cutoff_angle env_texture_size intrinsics scale_to_hfov type",
    "lidar": "noise range scan visibility_mask",
    "light": "attenuation cast_shadows diffuse direction intensity light_on pose specular spot "
    "visualize",
    "limit": "cfm dissipation effort erp lower stiffness upper velocity",
    "linear_acceleration": "x y z",
    "link": "audio_sink audio_source battery collision enable_wind gravity inertial kinematic "
    "light must_be_base_link particle_emitter plugin pose projector self_collide sensor "
    "velocity_decay visual",
    "logical_camera": "aspect_ratio far horizontal_fov near",
    "magnetometer": "x y z",
    "material": "ambient diffuse double_sided emissive lighting pbr render_order script shader "
    "shininess specular",
    "mesh": "convex_decomposition optimization scale submesh uri",
    "meta": "layer",
    "metal": "albedo_map ambient_occlusion_map emissive_map environment_map light_map metalness "
    "metalness_map normal_map roughness roughness_map",
    "mimic": "multiplier offset reference",
    "model": "allow_auto_disable enable_wind frame gripper include joint link model plugin pose "
    "self_collide static",
    "navsat": "position_sensing velocity_sensing",
    "noise": "bias_mean bias_stddev dynamic_bias_correlation_time dynamic_bias_stddev mean "
    "precision stddev type",
    "ode": "bounce cfm cfm_damping erp fdir1 fudge_factor implicit_spring_damper kd kp limit "
    "max_force max_vel min_depth mu mu2 slip slip1 slip2 soft_cfm soft_erp suspension "
    "velocity",
    "orientation_reference_frame": "custom_rpy grav_dir_x localization",
    "particle_emitter": "color_end color_range_image color_start duration emitting lifetime "
    "material "
    "max_velocity min_velocity particle_scatter_ratio particle_size pose rate scale_rate "
    "size topic",
    "pbr": "metal specular",
    "physics": "ode provide_feedback simbody",
    "plane": "normal size",
    "polyline": "height point",
    "position_sensing": "horizontal vertical",
    "pressure": "noise",
    "projector": "far_clip fov near_clip plugin pose texture visibility_flags",
    "range": "max min resolution",
    "ray": "noise range scan visibility_mask",
    "save": "path",
    "scan": "horizontal vertical",
    "script": "name uri",
    "sensor": "air_pressure air_speed altimeter always_on camera contact dvl enable_metrics "
    "force_torque frame_id gps imu lidar logical_camera magnetometer navsat plugin pose "
    "ray rfid rfidtag sonar topic transceiver update_rate visualize",
    "shader": "normal_map",
    "simbody": "must_be_loop_joint",
    "soft_contact": "dart",
    "sonar": "geometry max min radius",
    "specular": "albedo_map ambient_occlusion_map emissive_map environment_map glossiness "
    "glossiness_map light_map normal_map specular_map",
    "sphere": "radius",
    "spot": "falloff inner_angle outer_angle",
    "submesh": "center name",
    "surface": "bounce contact friction soft_contact",
    "suspension": "cfm erp",
    "texture": "diffuse normal size",
    "torque": "x y z",
    "torsional": "coefficient ode patch_radius surface_radius use_patch_radius",
    "transceiver": "essid frequency gain max_frequency min_frequency power sensitivity",
    "velocity_decay": "angular linear",
    "velocity_sensing": "horizontal vertical",
    "vertical": "max_angle min_angle noise resolution samples",
    "vertical_position": "noise",
    "vertical_velocity": "noise",
    "visual": "cast_shadows geometry laser_retro material meta plugin pose transparency "
    "visibility_flags",
    "x": "noise",
    "y": "noise",
    "z": "noise",
}

ELEMENTS = {tag: frozenset(children.split()) for tag, children in _CHILDREN.items()}
"""Allowed children of each element; other elements are not checked."""

DE_FACTO = frozenset(("gz_frame_id", "ignition_frame_id"))
"""Elements that no SDF version defines but Gazebo reads."""
