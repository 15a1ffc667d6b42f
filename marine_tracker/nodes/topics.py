"""Names of topics and their quality of service."""

from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy

from ..recording.ros_messages import FRAME  # noqa: F401

OWN_SHIP_FRAME = 'base_link'

PLOTS = 'radar/plots'
SPOKES = 'radar/spokes'
SECTOR = 'radar/sector'  # marine_sensor_msgs/RadarSector
IMAGE = 'radar/image'
PLOTS_READABLE = 'radar/plots_readable'
ODOMETRY = 'own_ship/odometry'
FIX = 'own_ship/fix'
LOG = 'own_ship/log'
OWN_SHIP_STATE = 'own_ship/state'
TRUTH = 'truth'
AIS_REPORTS = 'ais/reports'
AIS_SENTENCES = 'ais/sentences'  # as they came
AIS_SIMULATED = 'ais/simulated'  # sentences
AIS_TARGETS = 'ais/targets'
AIS_ACTIVATE = 'ais/activate'
AIS_SLEEP = 'ais/sleep'
TRACKS = 'tracks'
EXTRAPOLATIONS = 'extrapolations'
TRACKS_CLOUD = 'tracks_cloud'
RADAR_TRACKS = 'radar_tracks'  # radar_msgs/RadarTracks
TARGETS = 'targets'
TARGETS_CLOUD = 'targets_cloud'
MARKERS = 'markers'
NMEA = 'nmea'
ALARMS = 'alarms'
ALARMS_PAST = 'alarms_past'
TRIAL = 'trial'
DANGER_AREAS = 'danger_areas'
ACQUIRE = 'acquire'
CLICKED_POINT = 'clicked_point'
EXPLAIN = 'explain'
EXPLANATION = 'explanation'
VIDEO_EXPLANATION = 'video_explanation'
CANCEL = 'cancel'
ACKNOWLEDGE_TARGET = 'acknowledge_target'
ACKNOWLEDGE_ALERT = 'acknowledge_alert'
DIAGNOSTICS = '/diagnostics'
CLOCK = '/clock'

NUMBERS = CANCEL, ACKNOWLEDGE_TARGET, ACKNOWLEDGE_ALERT, AIS_ACTIVATE, AIS_SLEEP  # UInt32

CANCEL_ALL = 'cancel_all'  # services
ACKNOWLEDGE = 'acknowledge'
SILENCE = 'silence'
TRIAL_MANOEUVRE = 'trial_manoeuvre'

SECTORS = 64  # messages of plots that may wait: the sectors of a revolution
SPOKES_DEPTH = 16  # messages of spokes that may wait
BURST = 400  # messages published at once, one for each track or target


def reliable(depth: int = 10) -> QoSProfile:
    """Every message arrives, if no more than `depth` wait."""
    return QoSProfile(
        depth=depth, history=HistoryPolicy.KEEP_LAST, reliability=ReliabilityPolicy.RELIABLE
    )


def latched(depth: int = 1) -> QoSProfile:
    """Reliable; late subscribers still get the last `depth` messages."""
    return QoSProfile(
        depth=depth,
        history=HistoryPolicy.KEEP_LAST,
        reliability=ReliabilityPolicy.RELIABLE,
        durability=DurabilityPolicy.TRANSIENT_LOCAL,
    )


def best_available(depth: int = 10) -> QoSProfile:
    """Reliable if all present publishers are, else best effort."""
    return QoSProfile(
        depth=depth, history=HistoryPolicy.KEEP_LAST, reliability=ReliabilityPolicy.BEST_AVAILABLE
    )


def best_effort(depth: int = 10) -> QoSProfile:
    """Takes from every publisher; a message may get lost."""
    return QoSProfile(
        depth=depth, history=HistoryPolicy.KEEP_LAST, reliability=ReliabilityPolicy.BEST_EFFORT
    )
