//! The usual messages of ROS 2, for bags that are written and for those that hold no definitions: fields of std_msgs, geometry_msgs, sensor_msgs and
//! trajectory_msgs (common_interfaces, Humble to Jazzy; <https://docs.ros.org/en/jazzy/p/trajectory_msgs/>).

/// A message: its type, its fields and the messages in them.
struct Standard {
    name: &'static str,
    fields: &'static str,
    inside: &'static [&'static str],
}

const fn standard(
    name: &'static str,
    fields: &'static str,
    inside: &'static [&'static str],
) -> Standard {
    Standard {
        name,
        fields,
        inside,
    }
}

const TIME: &str = "builtin_interfaces/Time";
const DURATION: &str = "builtin_interfaces/Duration";
const HEADER: &str = "std_msgs/Header";
const VECTOR: &str = "geometry_msgs/Vector3";
const POINT: &str = "geometry_msgs/Point";
const QUATERNION: &str = "geometry_msgs/Quaternion";

#[rustfmt::skip] // A table: a message a line.
const STANDARDS: &[Standard] = &[
    standard(TIME, "int32 sec\nuint32 nanosec\n", &[]),
    standard(DURATION, "int32 sec\nuint32 nanosec\n", &[]),
    standard(HEADER, "builtin_interfaces/Time stamp\nstring frame_id\n", &[TIME]),
    standard("std_msgs/Bool", "bool data\n", &[]),
    standard("std_msgs/Int8", "int8 data\n", &[]),
    standard("std_msgs/Int16", "int16 data\n", &[]),
    standard("std_msgs/Int32", "int32 data\n", &[]),
    standard("std_msgs/Int64", "int64 data\n", &[]),
    standard("std_msgs/UInt8", "uint8 data\n", &[]),
    standard("std_msgs/UInt16", "uint16 data\n", &[]),
    standard("std_msgs/UInt32", "uint32 data\n", &[]),
    standard("std_msgs/UInt64", "uint64 data\n", &[]),
    standard("std_msgs/Float32", "float32 data\n", &[]),
    standard("std_msgs/Float64", "float64 data\n", &[]),
    standard("std_msgs/MultiArrayDimension", "string label\nuint32 size\nuint32 stride\n", &[]),
    standard("std_msgs/MultiArrayLayout", "MultiArrayDimension[] dim\nuint32 data_offset\n", &["std_msgs/MultiArrayDimension"]),
    standard("std_msgs/Float32MultiArray", "MultiArrayLayout layout\nfloat32[] data\n", &["std_msgs/MultiArrayLayout", "std_msgs/MultiArrayDimension"]),
    standard("std_msgs/Float64MultiArray", "MultiArrayLayout layout\nfloat64[] data\n", &["std_msgs/MultiArrayLayout", "std_msgs/MultiArrayDimension"]),
    standard(VECTOR, "float64 x\nfloat64 y\nfloat64 z\n", &[]),
    standard("geometry_msgs/Vector3Stamped", "std_msgs/Header header\nVector3 vector\n", &[HEADER, TIME, VECTOR]),
    standard(POINT, "float64 x\nfloat64 y\nfloat64 z\n", &[]),
    standard("geometry_msgs/PointStamped", "std_msgs/Header header\nPoint point\n", &[HEADER, TIME, POINT]),
    standard(QUATERNION, "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n", &[]),
    standard("geometry_msgs/Pose", "Point position\nQuaternion orientation\n", &[POINT, QUATERNION]),
    standard("geometry_msgs/PoseStamped", "std_msgs/Header header\nPose pose\n", &[HEADER, TIME, "geometry_msgs/Pose", POINT, QUATERNION]),
    standard("geometry_msgs/Twist", "Vector3 linear\nVector3 angular\n", &[VECTOR]),
    standard("geometry_msgs/TwistStamped", "std_msgs/Header header\nTwist twist\n", &[HEADER, TIME, "geometry_msgs/Twist", VECTOR]),
    standard("geometry_msgs/Accel", "Vector3 linear\nVector3 angular\n", &[VECTOR]),
    standard("geometry_msgs/AccelStamped", "std_msgs/Header header\nAccel accel\n", &[HEADER, TIME, "geometry_msgs/Accel", VECTOR]),
    standard("geometry_msgs/Wrench", "Vector3 force\nVector3 torque\n", &[VECTOR]),
    standard("geometry_msgs/WrenchStamped", "std_msgs/Header header\nWrench wrench\n", &[HEADER, TIME, "geometry_msgs/Wrench", VECTOR]),
    standard("sensor_msgs/JointState", "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort\n", &[HEADER, TIME]),
    standard("trajectory_msgs/JointTrajectoryPoint", "float64[] positions\nfloat64[] velocities\nfloat64[] accelerations\nfloat64[] effort\n\
        builtin_interfaces/Duration time_from_start\n", &[DURATION]),
    standard("trajectory_msgs/JointTrajectory", "std_msgs/Header header\nstring[] joint_names\nJointTrajectoryPoint[] points\n",
        &[HEADER, TIME, "trajectory_msgs/JointTrajectoryPoint", DURATION]),
    standard("sensor_msgs/FluidPressure", "std_msgs/Header header\nfloat64 fluid_pressure\nfloat64 variance\n", &[HEADER, TIME]),
    standard("sensor_msgs/Temperature", "std_msgs/Header header\nfloat64 temperature\nfloat64 variance\n", &[HEADER, TIME]),
    standard("sensor_msgs/Range", "std_msgs/Header header\nuint8 radiation_type\nfloat32 field_of_view\nfloat32 min_range\nfloat32 max_range\nfloat32 range\nfloat32 variance\n", &[HEADER, TIME]),
    standard("sensor_msgs/Imu", "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\nfloat64[9] orientation_covariance\n\
        geometry_msgs/Vector3 angular_velocity\nfloat64[9] angular_velocity_covariance\n\
        geometry_msgs/Vector3 linear_acceleration\nfloat64[9] linear_acceleration_covariance\n", &[HEADER, TIME, QUATERNION, VECTOR]),
];

/// The text of a definition, `std_msgs/msg/Bool` or `std_msgs/Bool`, with those of the messages in it.
#[must_use]
pub fn definition(name: &str) -> Option<String> {
    let find = |name: &str| STANDARDS.iter().find(|standard| standard.name == name);
    let own = find(&name.replace("/msg/", "/"))?;
    let mut text = own.fields.to_owned();
    for inside in own.inside {
        let fields = find(inside)?.fields;
        text += &format!("{}\nMSG: {inside}\n{fields}", "=".repeat(80));
    }
    Some(text)
}

/// Names of all of them.
#[cfg(test)]
pub(crate) fn names() -> impl Iterator<Item = &'static str> {
    STANDARDS.iter().map(|standard| standard.name)
}
