"""Names of SDF elements that may be in a ``<gazebo>`` block, since SDF 1.4.

In SDF, elements with the same name have similar children in all places.
"""

from __future__ import annotations

from ..words import split_words

SDF_CHILDREN: dict[str, frozenset[str]] = {
    "accel": split_words("bias_mean bias_stddev mean stddev"),
    "air_pressure": split_words("pressure reference_altitude"),
    "altimeter": split_words("vertical_position vertical_velocity"),
    "angular_velocity": split_words("x y z"),
    "attenuation": split_words("constant linear quadratic range"),
    "axis": split_words("dynamics initial_position limit mimic use_parent_model_frame xyz"),
    "axis2": split_words("dynamics initial_position limit use_parent_model_frame xyz"),
    "battery": split_words("voltage"),
    "blend": split_words("fade_dist min_height"),
    "bounce": split_words("restitution_coefficient threshold"),
    "box": split_words("size"),
    "bullet": split_words(
        "fdir1 friction friction2 kd kp rolling_friction soft_cfm soft_erp split_impulse "
        "split_impulse_penetration_threshold"
    ),
    "camera": split_words(
        "box_type camera_info_topic clip depth_camera distortion frame horizontal_fov image "
        "lens noise optical_frame_id pose save segmentation_type trigger_topic triggered "
        "visibility_mask visualize"
    ),
    "capsule": split_words("length radius"),
    "clip": split_words("far near"),
    "collision": split_words(
        "auto_inertia_params density frame geometry laser_retro max_contacts pose surface"
    ),
    "contact": split_words(
        "bullet category_bitmask collide_bitmask collide_without_contact "
        "collide_without_contact_bitmask collision elastic_modulus ode poissons_ratio topic"
    ),
    "custom_function": split_words("c1 c2 c3 f fun"),
    "cylinder": split_words("length radius"),
    "dart": split_words("bone_attachment damping flesh_mass_fraction stiffness"),
    "depth_camera": split_words("clip output"),
    "distortion": split_words("center k1 k2 k3 p1 p2"),
    "dynamics": split_words("damping friction spring_reference spring_stiffness"),
    "ellipsoid": split_words("radii"),
    "force": split_words("x y z"),
    "force_torque": split_words("force frame measure_direction torque"),
    "frame": split_words("pose"),
    "friction": split_words("bullet ode torsional"),
    "geometry": split_words(
        "box capsule cone cylinder ellipsoid empty heightmap image mesh plane polyline sphere"
    ),
    "gps": split_words("position_sensing velocity_sensing"),
    "grasp_check": split_words("attach_steps detach_steps min_contact_count"),
    "gripper": split_words("grasp_check gripper_link palm_link"),
    "horizontal": split_words("max_angle min_angle noise resolution samples"),
    "image": split_words("format granularity height scale threshold uri width"),
    "imu": split_words(
        "angular_velocity enable_orientation linear_acceleration noise "
        "orientation_reference_frame topic"
    ),
    "inertia": split_words("ixx ixy ixz iyy iyz izz"),
    "inertial": split_words("auto density fluid_added_mass frame inertia mass pose"),
    "intrinsics": split_words("cx cy fx fy s"),
    "joint": split_words(
        "axis axis2 child frame gearbox_ratio gearbox_reference_body parent physics pose "
        "sensor thread_pitch"
    ),
    "lens": split_words(
        "custom_function cutoff_angle env_texture_size intrinsics scale_to_hfov type"
    ),
    "lidar": split_words("noise range scan visibility_mask"),
    "light": split_words(
        "attenuation cast_shadows diffuse direction frame intensity pose specular spot"
    ),
    "limit": split_words("cfm dissipation effort erp lower stiffness upper velocity"),
    "linear_acceleration": split_words("x y z"),
    "link": split_words(
        "audio_sink audio_source battery collision enable_wind fluid_added_mass frame gravity "
        "inertial kinematic light must_be_base_link particle_emitter pose projector "
        "self_collide sensor velocity_decay visual"
    ),
    "logical_camera": split_words("aspect_ratio far horizontal_fov near"),
    "magnetometer": split_words("x y z"),
    "material": split_words(
        "ambient diffuse double_sided emissive lighting pbr render_order script shader specular"
    ),
    "mesh": split_words("scale submesh uri"),
    "meta": split_words("layer"),
    "metal": split_words(
        "albedo_map ambient_occlusion_map emissive_map environment_map light_map metalness "
        "metalness_map normal_map roughness roughness_map"
    ),
    "mimic": split_words("multiplier offset reference"),
    "model": split_words(
        "allow_auto_disable enable_wind frame gripper include joint link model "
        "placement_frame plugin pose self_collide static"
    ),
    "navsat": split_words("position_sensing velocity_sensing"),
    "noise": split_words(
        "accel bias_mean bias_stddev dynamic_bias_correlation_time dynamic_bias_stddev mean "
        "precision rate stddev type"
    ),
    "ode": split_words(
        "bounce cfm cfm_damping erp fdir1 fudge_factor implicit_spring_damper kd kp limit "
        "max_force max_vel min_depth mu mu2 provide_feedback slip slip1 slip2 soft_cfm "
        "soft_erp suspension velocity"
    ),
    "orientation_reference_frame": split_words("custom_rpy grav_dir_x localization"),
    "pbr": split_words("metal specular"),
    "physics": split_words("ode provide_feedback simbody"),
    "plane": split_words("normal size"),
    "polyline": split_words("height point"),
    "position_sensing": split_words("horizontal vertical"),
    "pressure": split_words("noise"),
    "range": split_words("max min resolution"),
    "rate": split_words("bias_mean bias_stddev mean stddev"),
    "ray": split_words("noise range scan visibility_mask"),
    "save": split_words("path"),
    "scan": split_words("horizontal vertical"),
    "script": split_words("name uri"),
    "sensor": split_words(
        "air_pressure altimeter always_on camera contact enable_metrics force_torque frame "
        "gps imu lidar logical_camera magnetometer navsat plugin pose projector ray rfid "
        "rfidtag sonar topic transceiver update_rate visualize"
    ),
    "shader": split_words("normal_map"),
    "simbody": split_words("must_be_loop_joint"),
    "soft_contact": split_words("dart"),
    "sonar": split_words("geometry max min radius"),
    "specular": split_words(
        "albedo_map ambient_occlusion_map emissive_map environment_map glossiness "
        "glossiness_map light_map normal_map specular_map"
    ),
    "sphere": split_words("radius"),
    "spot": split_words("falloff inner_angle outer_angle"),
    "submesh": split_words("center name"),
    "surface": split_words("bounce contact friction soft_contact"),
    "suspension": split_words("cfm erp"),
    "texture": split_words("diffuse normal size"),
    "torque": split_words("x y z"),
    "torsional": split_words("coefficient ode patch_radius surface_radius use_patch_radius"),
    "transceiver": split_words(
        "essid frequency gain max_frequency min_frequency power sensitivity"
    ),
    "velocity_decay": split_words("angular linear"),
    "velocity_sensing": split_words("horizontal vertical"),
    "vertical": split_words("max_angle min_angle noise resolution samples"),
    "vertical_position": split_words("noise"),
    "vertical_velocity": split_words("noise"),
    "visual": split_words(
        "cast_shadows frame geometry laser_retro material meta plugin pose transparency "
        "visibility_flags"
    ),
    "x": split_words("noise"),
    "y": split_words("noise"),
    "z": split_words("noise"),
}
"""Names of the children by the name of the element."""
