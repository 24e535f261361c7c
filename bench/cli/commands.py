"""The commands of the top level: what each is called, where it is, and its line in the help.

The order is that of the help: first what a newcomer needs, then what a bench needs every day, then the lab.
"""

from typing import NamedTuple


class CommandEntry(NamedTuple):
    """One command.

    Attributes:
        place: `module:attribute` of a function, or of a `typer.Typer` with commands of its own.
        help: first paragraph of its own help; `tests/cli/test_commands.py` compares the two.
    """

    name: str
    place: str
    help: str


COMMANDS = (
    CommandEntry(
        "demo",
        "bench.cli.evaluation.demo:demo",
        "Run the main job end to end: steps, load sweep, a hidden effect found. Prints tables, writes one HTML report.",
    ),
    CommandEntry(
        "paper",
        "bench.cli.evaluation.paper:paper",
        "Run the paper's experiments, and lay our figures and numbers beside its own. Minutes, on a simulated bench.",
    ),
    CommandEntry(
        "rivals",
        "bench.cli.evaluation.rivals:rivals",
        "Compare ways of compensation on the same samples of the simulated joint, with free play and without.",
    ),
    CommandEntry(
        "figures",
        "bench.cli.evaluation.figures:figures",
        "Measure the compensator's figures over many seeds and rigs, on all cores. Minutes; nothing is kept.",
    ),
    CommandEntry(
        "serve",
        "bench.cli.operation.serve:serve",
        "Serve the page and the REST interface for the bench, until Ctrl-C. Stops the joint when it ends.",
    ),
    CommandEntry(
        "doctor",
        "bench.cli.operation.doctor:doctor",
        "Connect to the drive and say what it is, what it measures and how fast; with --move, whether it is right.",
    ),
    CommandEntry(
        "commission",
        "bench.cli.operation.commission:commission",
        "Find out what a joint is by small motions, and write a bench.toml that compensates, with its evidence.",
    ),
    CommandEntry(
        "drive",
        "bench.cli.operation.drive:app",
        "The drive itself, without an experiment: its state, and the clearing of its fault. Its power stays off.",
    ),
    CommandEntry(
        "drives",
        "bench.cli.operation.drives:app",
        "What is on a port or a bus, with the section of bench.toml that reaches it. Nothing is powered or moved.",
    ),
    CommandEntry(
        "run",
        "bench.cli.operation.run:app",
        "Run one experiment on the bench: the joint moves. Ctrl-C stops it, and the record says so.",
    ),
    CommandEntry(
        "queue",
        "bench.cli.operation.queue:app",
        "Experiments one after the other, on a running service: list, add, move, remove, clear, pause, resume.",
    ),
    CommandEntry(
        "campaign",
        "bench.cli.operation.campaign:app",
        "Experiments over every combination of some parameters: plan, start.",
    ),
    CommandEntry("status", "bench.cli.operation.service:status", "Show what a running service's bench is doing."),
    CommandEntry(
        "benches",
        "bench.cli.operation.benches:benches",
        "List the benches of the laboratory: state, lease, queue, and what is not handed in yet.",
    ),
    CommandEntry(
        "lab-queue",
        "bench.cli.operation.lab_queue:app",
        "Experiments for whichever bench of the laboratory fits: list, add, campaign, remove. Each is run once.",
    ),
    CommandEntry(
        "stop",
        "bench.cli.operation.stop:stop",
        "Stop every joint that this user moves on this machine, and power it off; with --url that of one service.",
    ),
    CommandEntry(
        "experiments", "bench.cli.records.experiments:experiments", "List what has been run or imported, newest first."
    ),
    CommandEntry("trials", "bench.cli.records.trials:trials", "List trials in the order in which they were made."),
    CommandEntry(
        "trial",
        "bench.cli.records.trials:trial",
        "Show one trial: conditions, results, events; or all its samples as CSV or Parquet.",
    ),
    CommandEntry(
        "record",
        "bench.cli.records.record:record",
        "Record a servo or an actuator that another program moves (LeRobot, ROS 2, a vendor's tool).",
    ),
    CommandEntry(
        "export",
        "bench.cli.records.recordings:export",
        "Write all trials of an experiment: a recording set (rig.toml, trials.csv, one CSV per trial), or one Parquet.",
    ),
    CommandEntry(
        "import",
        "bench.cli.records.recordings:import_",
        "Read trials of any bench into the store: all of them, or none and the file, line and column at fault.",
    ),
    CommandEntry(
        "explain",
        "bench.cli.lab.explain:explain",
        "Import files of any bench, say what a model of the joint lacks, and write a report for a colleague.",
    ),
    CommandEntry(
        "calibrate",
        "bench.cli.operation.calibrate:app",
        "Friction curves of the joint, one per load, and what they are used for.",
    ),
    CommandEntry(
        "study",
        "bench.cli.lab.study:app",
        "Compare measured with predicted, name the missing effect, add it, watch the error fall.",
    ),
    CommandEntry(
        "store",
        "bench.cli.records.store:app",
        "Look after the store: information, check, repair, backup, vacuum, prune, remove.",
    ),
    CommandEntry(
        "token",
        "bench.cli.operation.token:app",
        "Make, list and revoke the tokens of the service. A running service knows within two seconds.",
    ),
    CommandEntry(
        "audit",
        "bench.cli.operation.audit:audit",
        "Show who changed what over the service, newest first. How long that is kept: [store.retention] audit_days.",
    ),
    CommandEntry("effects", "bench.cli.lab.effects:effects", "List the physical effects that a model can be made of."),
    CommandEntry(
        "simulate-device",
        "bench.cli.operation.simulate_device:app",
        "A drive in software that speaks its wire protocol, with a simulated joint on it.",
    ),
    CommandEntry(
        "challenge",
        "bench.cli.lab.challenge:challenge",
        "Draw a joint at random, hide nothing, one or two mechanisms in it, record it, and seal the answer.",
    ),
    CommandEntry(
        "reveal", "bench.cli.lab.challenge:reveal", "Open the sealed answer of a challenge, and score a guess."
    ),
    CommandEntry(
        "blind",
        "bench.cli.evaluation.blind:blind",
        "Draw joints, hide mechanisms or nothing in them, record them, and ask the model lab what is missing.",
    ),
    CommandEntry(
        "bench-report",
        "bench.cli.evaluation.bench_report:bench_report",
        "Run a small campaign on the simulated bench, and compare it with a baseline, seed by seed.",
    ),
)
