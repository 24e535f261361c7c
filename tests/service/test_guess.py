"""Files of unknown benches over REST: what their columns may be, and how they come in."""

import io
import zipfile

from tests.recording_set.foreign_files import FILES

TYPE = {"Content-Type": "application/zip"}


def zipped(**files: str | bytes) -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        for name, data in files.items():
            archive.writestr(name.replace("__", "."), data)
    return buffer.getvalue()


def test_a_german_spreadsheet_is_guessed_and_comes_in_with_that_mapping(service):
    data = FILES["german excel, windows-1252"].data
    before = service.client.get("/experiments").json()["items"]
    guessed = service.client.post("/recording-sets/guess?name=x", content=zipped(a__csv=data), headers=TYPE).json()
    assert (guessed["questions"], guessed["joint"]) == ([], "rotary")
    assert {one["channel"] for one in guessed["columns"]} == {"time_s", "position_rad", "current_a"}
    assert service.client.get("/experiments").json()["items"] == before  # a guess keeps nothing
    whole = zipped(a__csv=data, mapping__toml=guessed["mapping"], rig__toml=guessed["rig"])
    made = service.client.post("/recording-sets?name=x", content=whole, headers=TYPE)
    assert (made.status_code, made.json()["rows"]) == (201, 400)
    again = service.client.post("/recording-sets?name=y", content=whole, headers=TYPE).json()
    assert f"experiment {made.json()['experiment_id']} has the same recordings already" in again["notes"][-1]


def test_what_is_not_sure_is_asked_and_can_be_answered(service):
    body = zipped(a__csv=FILES["counts, not told"].data)
    asked = service.client.post("/recording-sets/guess?name=x", content=body, headers=TYPE).json()
    assert any("--counts-per-turn" in question for question in asked["questions"])
    query = {"name": "x", "counts_per_turn": 16384}
    answered = service.client.post("/recording-sets/guess", params=query, content=body, headers=TYPE).json()
    assert answered["questions"] == []
    assert "counts_per_turn = 16384" in answered["mapping"]


def test_without_a_mapping_the_refusal_names_both_ways(service):
    body = zipped(a__csv=FILES["german excel, utf-8 mark"].data, rig__toml='name = "r"')
    refused = service.client.post("/recording-sets?name=x", content=body, headers=TYPE)
    assert refused.status_code == 422
    for words in ("import --guess", "mapping.toml"):
        assert words in refused.json()["detail"]


def test_an_answer_that_is_none_is_refused(service):
    body = zipped(a__csv=FILES["plain"].data)
    refused = service.client.post("/recording-sets/guess?name=x&take=q", content=body, headers=TYPE)
    assert (refused.status_code, "NAME=QUANTITY[UNIT]" in refused.json()["detail"]) == (422, True)


def test_what_is_no_table_is_refused(service):
    body = zipped(a__csv=FILES["picture"].data)
    refused = service.client.post("/recording-sets/guess?name=x", content=body, headers=TYPE)
    assert (refused.status_code, "is no text" in refused.json()["detail"]) == (422, True)
