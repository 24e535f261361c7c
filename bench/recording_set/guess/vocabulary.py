"""Words that people call the quantities of a joint by, in several languages; and what else stands in such names."""


def _words(text: str) -> frozenset[str]:
    return frozenset(text.split())


# the first quantity that a word of a name belongs to is taken: what is more special stands before
WORDS: tuple[tuple[str, frozenset[str]], ...] = (
    ("temperature", _words("temperature temp temperatur température temperatura tmp tmot tmotor")),
    ("enabled", _words("enabled enable enb")),
    ("duty", _words("duty pwm dutycycle tastgrad")),
    (
        "supply",
        _words(
            "supply vbus ubus udc vdc vin battery batt vbat dclink zwischenkreis zwischenkreisspannung versorgung "
            "versorgungsspannung bus"
        ),
    ),
    ("acceleration", _words("acc accel acceleration beschleunigung accélération aceleración ddq qdd")),
    ("torque", _words("torque tau trq drehmoment moment couple par torsion koppel coppia effort")),
    ("force", _words("force kraft fuerza forza fz fx fy")),
    ("current", _words("current curr cur i iq amps amp strom motorstrom courant corriente corrente")),
    ("voltage", _words("voltage volt volts u uq vq spannung tension tensión voltaje tensione")),
    (
        "velocity",
        _words(
            "vel velocity speed omega ω w dq qd qdot dtheta thetadot rpm drehzahl geschwindigkeit "
            "winkelgeschwindigkeit vitesse velocidad velocità spd xdot"
        ),
    ),
    (
        "position",
        _words(
            "pos position angle ang winkel drehwinkel lage weg q theta phi posición posicion ángulo angulo posizione "
            "enc encoder counts count ticks displacement stroke x"
        ),
    ),
    (
        "time",
        _words(
            "t time zeit temps tiempo tempo timestamp stamp clock millis micros seconds secs sec date datum uhrzeit "
            "zeitstempel zeitpunkt elapsed datetime hora heure fecha ms us nanosec nsec nsecs"
        ),
    ),
)
TARGET = _words(
    "target ref reference setpoint set sp soll sollwert desired des cmd command commanded goal demand consigne wanted "
    "objetivo referencia dem"
)
ERROR = _words("error err deviation abweichung fehler schleppfehler erreur residual std rms var covariance status")
MEASURED = _words("actual act measured meas ist istwert feedback fb present real mes mesuré medido encoder")
DERIVED = _words("filtered filt lp smooth estimate estimated est sim simulated model hat pred predicted")
SENSOR = _words("sensor cell loadcell transducer messwelle measured external extern output load")
OTHER_AXIS = _words("d id ia ib ic phase a b c")  # of a vector drive: not what makes torque
JOINT_SIDE = _words("joint output link arm load abtrieb gelenk")
