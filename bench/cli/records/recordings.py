"""`friction-bench export` and `import`: recording sets leave and enter."""

import shlex
from enum import Enum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from bench.cli.bench_session import BenchSession, session_of
from bench.cli.output import Json, print_json, say, write_whole
from bench.cli.records.guessed import (
    CountsPerTurn,
    RateHz,
    SupplyV,
    Take,
    known_of,
    remark_imported_before,
    show,
    write_guess,
)

if TYPE_CHECKING:  # imported when needed: `--help` starts at once
    from bench.recording_set.guess import Known

_GUESS = (
    "Import nothing: show what each column seems to be, by its name and values, and write that to a mapping file "
    "(--mapping, or mapping.toml; of a folder, in it). What is not sure is asked; answer with the options below."
)


class Effort(Enum):
    """What a JointState's effort is."""

    TORQUE = "torque_n_m"
    CURRENT = "current_a"
    DUTY = "duty"


def export(
    context: typer.Context,
    experiment: Annotated[int, typer.Argument(help="Number of the experiment.")],
    path: Annotated[Path, typer.Argument(help="A folder to make, or a file that ends in .zip or .parquet.")],
) -> None:
    """Write all trials of an experiment: a recording set (rig.toml, trials.csv, one CSV per trial), or one Parquet."""
    from bench.recording_set import export_experiment, export_parquet

    with session_of(context).open_store() as store:
        if path.suffix.lower() == ".parquet":
            write_whole(path, export_parquet(store, experiment))
        else:
            export_experiment(store, experiment, path)
    say(f"experiment {experiment} is in {path}")


def import_(
    context: typer.Context,
    path: Annotated[
        list[Path],
        typer.Argument(
            metavar="PATH...",
            help="Folder or .zip of a recording set, or files: each a trial; with --joint, a ROS 2 bag (.mcap), or a "
            "folder of them.",
        ),
    ],
    rig: Annotated[
        Path | None,
        typer.Option(
            help="rig.toml, where the set has none or another is wanted. --guess reads it, and without it writes one."
        ),
    ] = None,
    mapping: Annotated[
        Path | None,
        typer.Option(help="mapping.toml, for files whose columns have other names. --guess writes it."),
    ] = None,
    name: Annotated[str | None, typer.Option(help="Name of the import; without it, that of the set.")] = None,
    guess: Annotated[bool, typer.Option("--guess", help=_GUESS)] = False,
    take: Take = None,
    counts_per_turn: CountsPerTurn = None,
    rate_hz: RateHz = None,
    supply_v: SupplyV = None,
    joint: Annotated[
        str, typer.Option(help="Joint of the JointState messages of a ROS 2 bag; --rig says what it is.")
    ] = "",
    topic: Annotated[str, typer.Option(help="Topic of these messages; else the only one there is.")] = "",
    effort: Annotated[
        Effort, typer.Option(help="What their publisher puts into 'effort'; ROS says torque.")
    ] = Effort.TORQUE,
    as_json: Json = False,
) -> None:
    """Read trials of any bench into the store: all of them, or none and the file, line and column at fault."""
    from bench.recording_set import (
        import_recording_set,
        read_mapping,
        read_recording_set,
        read_rig,
        read_ros2_bags,
    )

    if guess:
        known = known_of(take, counts_per_turn, rate_hz, supply_v)
        beside = path[0] if len(path) == 1 and path[0].is_dir() else Path()  # a set brings its mapping along
        _guess(session_of(context), path, rig, known, mapping or beside / "mapping.toml")
        return
    chosen_rig = None if rig is None else read_rig(rig)
    if joint and chosen_rig is not None and mapping is None and len(path) == 1:
        recording_set = read_ros2_bags(path[0], chosen_rig, joint, effort.value, topic)
    elif joint:
        raise typer.BadParameter("--joint is of one ROS 2 bag: it goes with --rig rig.toml, and without --mapping")
    else:
        chosen_mapping = None if mapping is None else read_mapping(mapping)
        recording_set = read_recording_set(path, chosen_mapping, chosen_rig)
    with session_of(context).open_store() as store:
        remark_imported_before(store, recording_set)
        experiment_id = import_recording_set(store, recording_set, name or recording_set.name)
    rows = sum(len(recording) for recording in recording_set.recordings)
    trials = len(recording_set.recordings)
    if as_json:
        print_json({"experiment_id": experiment_id, "name": name or recording_set.name, "trials": trials, "rows": rows})
        return
    for note in recording_set.notes:
        say(note)
    say(f"imported as experiment {experiment_id}: {trials} trial{'s' * (trials != 1)}, {rows} rows")
    called = shlex.quote(name or recording_set.name)
    say(session_of(context).in_full(f"next: friction-bench study new {called} --experiment {experiment_id}"))


def _guess(session: BenchSession, paths: list[Path], rig: Path | None, known: "Known", mapping_file: Path) -> None:
    """Show what the columns are taken for; write mapping and rig where nothing is left to be asked."""
    from bench.recording_set import read_rig
    from bench.recording_set.guess import check_answered, guess_of

    found, assumed, notes = guess_of(paths, None if rig is None else read_rig(rig), known)
    show(found, notes)
    check_answered(found)
    rig_file = mapping_file.with_name("rig.toml")
    needs_rig = rig is None and not (paths[0] / "rig.toml").exists()
    write_guess(found, assumed if needs_rig else None, mapping_file, rig_file)
    words = [*map(str, paths), "--mapping", str(mapping_file)]
    if named := rig_file if needs_rig else rig:
        words += ["--rig", str(named)]
    say(session.in_full(f"then: friction-bench import {shlex.join(words)}"))
