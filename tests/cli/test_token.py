"""`friction-bench token` and `audit`."""

import json
from importlib import resources

from bench.service.auth.tokens import digest_of
from bench.store import Store


def test_a_token_from_its_making_to_its_end(command, tmp_path):
    made = command("token", "new", "ada", "--role", "operator", "--expires-days", "30")
    assert made.exit_code == 0, made.output
    token = made.stdout.strip()
    assert len(token) == 43
    with Store.open(f"sqlite:///{tmp_path / 'friction-bench.sqlite'}") as store:
        [kept] = store.access.tokens.find()
    assert (kept.name, kept.role, kept.digest) == ("ada", "operator", digest_of(token))
    [listed] = json.loads(command("token", "list", "--json").stdout)
    assert listed["valid"] is True
    assert listed["expires_utc"] > listed["created_utc"]
    assert command("token", "revoke", "ada").exit_code == 0
    assert "no" in command("token", "list").stdout
    again = command("token", "revoke", "ada")
    assert again.exit_code == 3
    assert "revoked already" in again.stderr


def test_the_store_is_named(command, tmp_path):
    file = str(tmp_path / "friction-bench.sqlite")
    made = command("token", "new", "ada")
    assert len(made.stdout.strip()) == 43  # a shell takes it from there
    assert file in made.stderr
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    listed = command("--store", elsewhere / "other.sqlite", "token", "list")
    assert str(elsewhere / "other.sqlite") in listed.stdout.replace("\n", "")


def test_names_are_never_given_twice(command):
    assert command("token", "new", "ada").exit_code == 0
    twice = command("token", "new", "ada")
    assert twice.exit_code == 3
    assert "there is or was a token 'ada'" in twice.stderr
    assert command("token", "new", "environment").exit_code == 3
    assert command("token", "revoke", "bob").exit_code == 3
    assert command("token", "new", "bob", "--role", "king").exit_code == 2


def test_making_and_revoking_is_on_record(command):
    token = json.loads(command("token", "new", "ada", "--json").stdout)["token"]
    command("token", "revoke", "ada")
    shown = command("audit").stdout
    assert "made token 'ada' with the role operator, by user" in shown
    assert "revoked token 'ada'" in shown
    assert token not in shown
    assert [one["path"] for one in json.loads(command("audit", "--json").stdout)] == [
        "token revoke ada",
        "token new ada",
    ]
    assert json.loads(command("audit", "--token", "nobody", "--json").stdout) == []


def test_the_audit_log_has_its_retention(command, tmp_path):
    config = tmp_path / "bench.toml"
    preset = (resources.files("bench.config") / "presets" / "paper.toml").read_text(encoding="utf-8")
    config.write_text(preset + "\n[store.retention]\naudit_days = 1\n")
    command("token", "new", "ada")
    pruned = command("--config", config, "store", "prune", "--delete")
    assert pruned.exit_code == 0, pruned.output
    assert "0 entries of the audit log removed" in pruned.stdout


def test_a_token_that_would_open_nothing_is_not_made(command):
    refused = command("token", "new", "ada", "--expires-days", "0")
    assert refused.exit_code == 2
    assert json.loads(command("token", "list", "--json").stdout) == []
