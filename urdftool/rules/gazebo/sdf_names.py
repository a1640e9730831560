"""Names of SDF elements that may be in a ``<gazebo>`` block, since SDF 1.4.

In SDF, elements with the same name have similar children in all places.
"""

from __future__ import annotations

from ..words import words

SDF_CHILDREN: dict[str, frozenset[str]] = {
    "accel": words("bias_mean bias_stddev mean stddev"),
    "air_pressure": words("pressure reference_altitude"),
    "altimeter": words("vertical_position vertical_velocity"),
    "angular_velocity": words("x y z"),
    "attenuation": words("constant linear quadratic range"),
    "axis": words("dynamics initial_position limit mimic use_parent_model_frame xyz"),
    "axis2": words("dynamics initial_position limit use_parent_model_frame xyz"),
    "battery": words("voltage"),
    "blend": words("fade_dist min_height"),
    "bounce": words("restitution_coefficient threshold"),
    "box": words("size"),
    "bullet": words(
        "fdir1 friction friction2 kd kp rolling_friction soft_cfm soft_erp split_impulse "
        "split_impulse_penetration_threshold"
    ),
    "camera": words(
        "box_type camera_info_topic clip depth_camera distortion frame horizontal_fov image "
        "lens noise optical_frame_id pose save segmentation_type trigger_topic triggered "
        "visibility_mask visualize"
    ),
    "capsule": words("length radius"),
    "clip": words("far near"),
    "collision": words(
        "auto_inertia_params density frame geometry laser_retro max_contacts pose surface"
    ),
    "contact": words(
        "bullet category_bitmask collide_bitmask collide_without_contact "
        "collide_without_contact_bitmask collision elastic_modulus ode poissons_ratio topic"
    ),
    "custom_function": words("c1 c2 c3 f fun"),
    "cylinder": words("length radius"),
    "dart": words("bone_attachment damping flesh_mass_fraction stiffness"),
    "depth_camera": words("clip output"),
    "distortion": words("center k1 k2 k3 p1 p2"),
    "dynamics": words("damping friction spring_reference spring_stiffness"),
    "ellipsoid": words("radii"),
    "force": words("x y z"),
    "force_torque": words("force frame measure_direction torque"),
    "frame": words("pose"),
    "friction": words("bullet ode torsional"),
    "geometry": words(
        "box capsule cone cylinder ellipsoid empty heightmap image mesh plane polyline sphere"
    ),
    "gps": words("position_sensing velocity_sensing"),
    "grasp_check": words("attach_steps detach_steps min_contact_count"),
    "gripper": words("grasp_check gripper_link palm_link"),
    "horizontal": words("max_angle min_angle noise resolution samples"),
    "image": words("format granularity height scale threshold uri width"),
    "imu": words(
        "angular_velocity enable_orientation linear_acceleration noise "
        "orientation_reference_frame topic"
    ),
    "inertia": words("ixx ixy ixz iyy iyz izz"),
    "inertial": words("auto density fluid_added_mass frame inertia mass pose"),
    "intrinsics": words("cx cy fx fy s"),
    "joint": words(
        "axis axis2 child frame gearbox_ratio gearbox_reference_body parent physics pose "
        "sensor thread_pitch"
    ),
    "lens": words("custom_function cutoff_angle env_texture_size intrinsics scale_to_hfov type"),
    "lidar": words("noise range scan visibility_mask"),
    "light": words("attenuation cast_shadows diffuse direction frame intensity pose specular spot"),
    "limit": words("cfm dissipation effort erp lower stiffness upper velocity"),
    "linear_acceleration": words("x y z"),
    "link": words(
        "audio_sink audio_source battery collision enable_wind fluid_added_mass frame gravity "
        "inertial kinematic light must_be_base_link particle_emitter pose projector "
        "self_collide sensor velocity_decay visual"
    ),
    "logical_camera": words("aspect_ratio far horizontal_fov near"),
    "magnetometer": words("x y z"),
    "material": words(
        "ambient diffuse double_sided emissive lighting pbr render_order script shader specular"
    ),
    "mesh": words("scale submesh uri"),
    "meta": words("layer"),
    "metal": words(
        "albedo_map ambient_occlusion_map emissive_map environment_map light_map metalness "
        "metalness_map normal_map roughness roughness_map"
    ),
    "mimic": words("multiplier offset reference"),
    "model": words(
        "allow_auto_disable enable_wind frame gripper include joint link model "
        "placement_frame plugin pose self_collide static"
    ),
    "navsat": words("position_sensing velocity_sensing"),
    "noise": words(
        "accel bias_mean bias_stddev dynamic_bias_correlation_time dynamic_bias_stddev mean "
        "precision rate stddev type"
    ),
    "ode": words(
        "bounce cfm cfm_damping erp fdir1 fudge_factor implicit_spring_damper kd kp limit "
        "max_force max_vel min_depth mu mu2 provide_feedback slip slip1 slip2 soft_cfm "
        "soft_erp suspension velocity"
    ),
    "orientation_reference_frame": words("custom_rpy grav_dir_x localization"),
    "pbr": words("metal specular"),
    "physics": words("ode provide_feedback simbody"),
    "plane": words("normal size"),
    "polyline": words("height point"),
    "position_sensing": words("horizontal vertical"),
    "pressure": words("noise"),
    "range": words("max min resolution"),
    "rate": words("bias_mean bias_stddev mean stddev"),
    "ray": words("noise range scan visibility_mask"),
    "save": words("path"),
    "scan": words("horizontal vertical"),
    "script": words("name uri"),
    "sensor": words(
        "air_pressure altimeter always_on camera contact enable_metrics force_torque frame "
        "gps imu lidar logical_camera magnetometer navsat plugin pose projector ray rfid "
        "rfidtag sonar topic transceiver update_rate visualize"
    ),
    "shader": words("normal_map"),
    "simbody": words("must_be_loop_joint"),
    "soft_contact": words("dart"),
    "sonar": words("geometry max min radius"),
    "specular": words(
        "albedo_map ambient_occlusion_map emissive_map environment_map glossiness "
        "glossiness_map light_map normal_map specular_map"
    ),
    "sphere": words("radius"),
    "spot": words("falloff inner_angle outer_angle"),
    "submesh": words("center name"),
    "surface": words("bounce contact friction soft_contact"),
    "suspension": words("cfm erp"),
    "texture": words("diffuse normal size"),
    "torque": words("x y z"),
    "torsional": words("coefficient ode patch_radius surface_radius use_patch_radius"),
    "transceiver": words("essid frequency gain max_frequency min_frequency power sensitivity"),
    "velocity_decay": words("angular linear"),
    "velocity_sensing": words("horizontal vertical"),
    "vertical": words("max_angle min_angle noise resolution samples"),
    "vertical_position": words("noise"),
    "vertical_velocity": words("noise"),
    "visual": words(
        "cast_shadows frame geometry laser_retro material meta plugin pose transparency "
        "visibility_flags"
    ),
    "x": words("noise"),
    "y": words("noise"),
    "z": words("noise"),
}
"""Names of the children by the name of the element."""
