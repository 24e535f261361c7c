"""The load estimator on the bench: made from the calibration in use, fed with every reading."""

from dataclasses import replace
from math import nan, pi

from bench.config.configuration import BenchConfiguration
from bench.config.friction_curves import FrictionCurve, StudiedModel
from bench.config.reflected_load import load_current_a, torque_n_m_a
from bench.config.rig import Rig, resolution_rad
from bench.config.sections import RestSettings
from bench.control.cycle import Reading
from bench.errors import ConfigurationError
from bench.experiments.analysis.rest_estimate import RestFinding, finding
from bench.experiments.parts.joint import Joint, Part
from compensator.errors import CompensatorError
from compensator.motion import load_estimator
from compensator.motion.load_estimator import EstimatorSettings, JointModel, LoadEstimate, Observation, RestResult
from compensator.motion.local_motion import LEAST_READINGS

RIGHT_ANGLE_RAD = pi / 2
LEAST_SCATTER = 0.02  # of friction along the path, where the joint at rest does not show more
WINDOW_S = 0.2  # that speed and acceleration are taken from; free play lets the arm rattle faster than that
STUCK_S = 0.2
NO_CURVES = (
    "there are no friction curves to compensate motion with. Run `friction-bench calibrate run`, or choose a "
    "calibration that there is"
)


class LoadFollower:
    """Follows the load of a joint, reading after reading.

    Args:
        configuration: of the bench; with friction curves.

    Raises:
        ConfigurationError: there are none, they do not rise with the load, or the rig leaves out what is needed.
    """

    def __init__(self, configuration: BenchConfiguration) -> None:
        self._configuration = configuration
        self._model = joint_model(configuration)
        self._settings = estimator_settings(configuration)
        self._state = load_estimator.begin(self._model.friction.selectors[0])

    @property
    def estimate(self) -> LoadEstimate:
        """The last one."""
        return self._state.estimate

    def begin(self, joint: Joint) -> Part[str]:
        """The joint to rest at angle 0, and a zero-speed search there: what hangs there selects the friction curve.

        Returns:
            Why the search has no estimate; "" where it has.
        """
        yield from joint.wake()
        yield from joint.rest_at(0.0)
        found = yield from joint.search(0.0)
        if not found.failure:
            self.take(joint.reading, 0.0, finding([found], self._configuration))
        return found.failure

    def observe(self, reading: Reading, target_rad: float = nan, searching: bool = False) -> LoadEstimate:
        """One control cycle."""
        sample = reading.sample
        return self._advance(
            Observation(
                sample.position_rad, reading.current_a, target_rad, searching, temperature_c=sample.temperature_c
            )
        )

    def take(self, reading: Reading, target_rad: float, found: RestFinding) -> LoadEstimate:
        """What a zero-speed search found, in the cycle in which it ended."""
        rest = RestResult(found.load_current_a, found.half_width_a, found.friction_current_a)
        return self._advance(Observation(reading.sample.position_rad, reading.current_a, target_rad, rest=rest))

    def _advance(self, observation: Observation) -> LoadEstimate:
        self._state, estimate = load_estimator.advance(self._model, self._settings, self._state, observation)
        return estimate


def joint_model(configuration: BenchConfiguration) -> JointModel:
    """What is known of the joint in motion: friction by calibration, inertia and lever by the rig where it says them.

    Raises:
        ConfigurationError: no friction curves, curves that do not rise with the load, or a rig that leaves out what a
            load current needs.
    """
    if configuration.friction is None:
        raise ConfigurationError(NO_CURVES)
    rig = configuration.rig
    curves = sorted(configuration.friction.curves, key=lambda one: one.f_load_a)
    rotor = _rotor_inertia_a_s2_rad(rig)
    rest = RestSettings() if configuration.rest is None else configuration.rest
    try:
        found = JointModel(
            friction=configuration.friction.over_friction(),
            ratio=rig.gear.ratio or 1.0,
            rotor_inertia_a_s2_rad=rotor,
            arm_inertia_a_s2_rad=tuple(_arm_inertia_a_s2_rad(rig, one, rotor) for one in curves),
            offsets_a=tuple(one.offset_a for one in curves),
            rise_offsets_a=tuple(one.rise_offset_a for one in curves),
            gravity_a=tuple(load_current_a(one.load_kg, RIGHT_ANGLE_RAD, rig) for one in curves),
            gear_loss=rest.calibration().gear_loss(),
            friction_scatter=max(rest.scatter, LEAST_SCATTER),
        )
        studied = configuration.friction.study
        return found if studied is None else _of_study(found, studied, curves, rig)
    except CompensatorError as error:
        raise ConfigurationError(f"the friction curves cannot be looked up by F_load: {error}") from error


def _of_study(found: JointModel, studied: StudiedModel, curves: list[FrictionCurve], rig: Rig) -> JointModel:
    """The joint as a study found it in motion; what hangs on it is still selected by the curves."""
    from bench.experiments.parts.studied import online_friction  # the lab is loaded where a study is used

    per_a, length_m = torque_n_m_a(rig), rig.arm.length_m or 0.0
    rotor, arm = _before_and_behind_a_s2_rad(rig, studied.inertia_n_m_s2_rad / per_a)
    of_loads = (studied.load_inertia_scale * one.load_kg * length_m**2 / per_a for one in curves)
    return replace(
        found,
        rotor_inertia_a_s2_rad=rotor,
        arm_inertia_a_s2_rad=tuple(arm + of_load for of_load in of_loads),
        studied=online_friction(studied, rig),
    )


def estimator_settings(configuration: BenchConfiguration) -> EstimatorSettings:
    """The estimator in control cycles and encoder counts.

    Raises:
        ConfigurationError: the rig leaves out counts, ratio or backlash.
    """
    period_s, free_play_rad = configuration.control.period_s, configuration.rig.gear.backlash_rad
    if free_play_rad is None:
        raise ConfigurationError(
            f"rig '{configuration.rig.name}': gear.backlash_rad [rad] is needed to follow a load through a reversal; "
            "add it to the rig"
        )
    return EstimatorSettings(
        period_s=period_s,
        count_rad=resolution_rad(configuration.rig),
        free_play_rad=free_play_rad,
        dead_band_rad=configuration.servo.dead_band_rad,
        window=max(LEAST_READINGS, round(WINDOW_S / period_s)),
        rest_cycles=configuration.motion.settled_cycles,
        stuck_cycles=max(configuration.motion.settled_cycles, round(STUCK_S / period_s)),
    )


def _rotor_inertia_a_s2_rad(rig: Rig) -> float:
    """Current per joint acceleration of the rotor; 0 where the rig does not know it: then it counts as arm."""
    if rig.motor.rotor_inertia_kg_m2 is None or rig.motor.torque_constant_n_m_a is None or rig.gear.ratio is None:
        return 0.0
    return rig.motor.rotor_inertia_kg_m2 * rig.gear.ratio / rig.motor.torque_constant_n_m_a


def _before_and_behind_a_s2_rad(rig: Rig, whole: float) -> tuple[float, float]:
    """Current per joint acceleration of rotor and arm without load, which motion with the teeth closed tells as one.

    In the free play the arm falls with its own share: by the rig where it says that, else all that is not rotor.
    """
    known = rig.arm.inertia_kg_m2
    arm = max(whole - _rotor_inertia_a_s2_rad(rig), 0.0) if known is None else min(known / torque_n_m_a(rig), whole)
    return whole - arm, arm


def _arm_inertia_a_s2_rad(rig: Rig, curve: FrictionCurve, rotor: float) -> float:
    """Of arm and load: by the rig where it says them, else what the calibration found, the rotor taken off."""
    inertia, length_m = rig.arm.inertia_kg_m2, rig.arm.length_m
    if inertia is None or length_m is None:
        return max(curve.inertia_a_s2_rad * (rig.gear.ratio or 1.0) - rotor, 0.0)
    return (inertia + curve.load_kg * length_m**2) / torque_n_m_a(rig)
