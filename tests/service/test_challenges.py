"""A challenge over REST: made, studied by its recordings alone, guessed at, revealed."""

import json

import pytest

from bench.evaluation.challenge import difficulty, kept
from bench.evaluation.challenge.answer import Answer, Truth
from bench.evaluation.challenge.difficulty import Difficulty
from bench.evaluation.challenge.kept import answer_of
from bench.service.routes.challenges import Reveal, _reveal

QUICK = Difficulty((0.0, 1.0, 0.0), (0.8, 1.0), 0.001, (1.0,), 2.0, 1, 1)
SEED = 3


@pytest.fixture(scope="module")
def challenge(service):
    patch = pytest.MonkeyPatch()
    patch.setitem(difficulty.DIFFICULTIES, "easy", QUICK)
    answer = service.client.post("/challenges", json={"difficulty": "easy", "seed": SEED})
    patch.undo()
    assert answer.status_code == 201, answer.text
    return answer.json()


def test_it_is_listed_and_its_answer_is_not_told(service, challenge):
    number = challenge["challenge_id"]
    assert challenge in service.stranger.get("/challenges").json()["items"]
    truth = answer_of(service.store, number).truths[0]
    told = json.dumps([challenge, service.stranger.get(f"/experiments/{number}").json()])
    assert truth.title not in told
    assert truth.name not in told
    assert str(truth.size) not in told
    assert service.stranger.get(f"/trials?experiment_id={number}").json()["items"]


def test_the_list_is_paged(service, challenge):
    whole = service.stranger.get("/challenges").json()
    first = service.stranger.get("/challenges?limit=1").json()
    assert first["items"] == whole["items"][:1]
    beyond = service.stranger.get("/challenges", params={"offset": len(whole["items"])}).json()
    assert (beyond["items"], beyond["next_offset"]) == ([], None)


def test_a_right_guess_is_right_and_a_wrong_one_tells_what_was_missed(service, challenge):
    path = f"/challenges/{challenge['challenge_id']}/reveal"
    first = service.client.post(path, json={"guess": "nothing"}).json()
    assert not first["perfect"]
    assert len(first["missed"]) == len(first["hidden"]) == 1
    names = first["hidden"][0]["effects"]
    right = service.client.post(path, json={"guess": names[0] if names else "none-of-these"}).json()
    assert right["perfect"]
    assert right["right"] == first["missed"]
    assert "just that" in right["sentence"]
    again = service.client.post(path, json={"guess": right["guessed"]})  # as an answer has it: a list
    assert (again.status_code, again.json()) == (200, right)
    assert service.client.post(path, json={"guess": []}).json() == first
    assert service.client.post(path, json={"guess": ["spring,nothing"]}).status_code == 422


def test_what_cannot_be_revealed_says_why(service, challenge):
    path = f"/challenges/{challenge['challenge_id']}/reveal"
    assert service.stranger.post(path, json={"guess": "nothing"}).status_code == 401
    for body in ({}, {"guess": "nothing", "study_id": 1}):
        answer = service.client.post(path, json=body)
        assert answer.status_code == 422
        assert "one of guess and study_id" in answer.json()["detail"]
    assert "moonlight" in service.client.post(path, json={"guess": "moonlight"}).json()["detail"]
    other = service.run("steps", repeats=1)["experiment_id"]
    answer = service.client.post(f"/challenges/{other}/reveal", json={"guess": "nothing"})
    assert answer.status_code == 404
    assert "is no challenge" in answer.json()["detail"]


@pytest.mark.parametrize(("at_most", "missed"), [(2e-4, 0), (0.02, 1)])
def test_what_the_recordings_hold_next_to_nothing_of_is_not_missed(monkeypatch, at_most, missed):
    truth = Truth("spring", "a spring", 1.0, "stiffness", "N m/rad", 1e-4, {}, at_most)
    monkeypatch.setattr(kept, "answer_of", lambda *_: Answer(1, "hard", 0, (truth,), {}))
    told = _reveal(None, 1, Reveal(guess="nothing"))
    assert (len(told.missed), len(told.faint)) == (missed, 1 - missed)
    assert told.hidden[0].share_words == f"at most {100 * at_most:g} %"
    assert ("hold next to nothing of it" in told.sentence) == (not missed)
    assert ("all that these recordings can tell" in told.sentence) == (not missed)
