"""The bench of the paper, with another plant behind its drive."""

from bench.config.configuration import default_configuration


def bench_with(seed=1, **plant):
    """Components of the plant by name, each a table of values, as in bench.toml."""
    plain = default_configuration()
    drive = plain.drive.model_copy(update={"plant": plant, "seed": seed})
    return plain.model_copy(update={"drive": drive})


def dry_plant(coulomb_n_m, viscous_n_m_s_rad):
    """No free play, no scatter, no loss in the mesh, no Stribeck effect: friction of the motor's side alone."""
    return {
        "gear": {"backlash_rad": 0.0},
        "friction": {
            "coulomb_n_m": coulomb_n_m, "static_n_m": coulomb_n_m, "viscous_n_m_s_rad": viscous_n_m_s_rad,
            "growth_per_n": 0.0,
        },
        "arm_friction": {"coulomb_n_m": 0.0, "static_n_m": 0.0, "viscous_n_m_s_rad": 0.0},
        "load_friction": {"driving": 0.0, "back_driving": 0.0},
        "scatter": {"static_fraction": 0.0, "coulomb_fraction": 0.0},
    }  # fmt: skip
