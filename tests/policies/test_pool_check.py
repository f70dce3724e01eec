import json
from importlib.resources import files

import pytest

from policies import Parameters, StimulusError, format_maze, parse_maze, pool_check
from policies.pool import content_hash
from policies.pool_build import package_mazes, scene
from policies.pool_check import check


class Copy:
    """A copy of the committed pool that a test damages."""

    def __init__(self, folder):
        self.folder = folder
        source = files("policies").joinpath("stimuli")
        self.pool = json.loads(source.joinpath("pool.json").read_text(encoding="utf-8"))
        self.manifest = json.loads(source.joinpath("manifest.json").read_text(encoding="utf-8"))
        for name in ("pool.json", "manifest.json"):
            (folder / name).write_bytes(source.joinpath(name).read_bytes())

    def rename(self):
        """Give every stimulus the id of its content again."""
        for s in (*self.pool["stimuli"], self.pool["practice"]):
            fields = {key: value for key, value in s.items() if key != "id"}
            s["id"] = content_hash([self.pool["scenes"][s["maze"]], fields])[:12]

    def save(self):
        for name, content in (("pool.json", self.pool), ("manifest.json", self.manifest)):
            (self.folder / name).write_text(json.dumps(content), encoding="utf-8")

    def of(self, scenario, condition):
        return next(
            s
            for s in self.pool["stimuli"]
            if (s["scenario"], s["condition"]) == (scenario, condition)
        )

    def fails_with(self, said, rename=True):
        if rename:
            self.rename()
        self.save()
        with pytest.raises(StimulusError, match=said):
            check(self.folder)


@pytest.fixture
def copy(tmp_path):
    return Copy(tmp_path)


def test_what_is_committed_keeps_every_rule():
    proved: list[str] = []
    check(progress=proved.append)
    assert len(proved) == len(set(proved)) == 14


def test_an_undamaged_copy_keeps_every_rule(copy):
    check(copy.folder)


class TestFiles:
    @pytest.mark.parametrize("name", ["pool.json", "manifest.json"])
    def test_both_are_there(self, copy, name):
        (copy.folder / name).unlink()
        with pytest.raises(StimulusError, match=f"{name}: expected a readable file"):
            check(copy.folder)

    @pytest.mark.parametrize("text", ["", "[]", "{}"])
    def test_the_manifest_has_a_seed(self, copy, text):
        (copy.folder / "manifest.json").write_text(text, encoding="utf-8")
        with pytest.raises(StimulusError, match=r"manifest\.json: expected JSON with a seed"):
            check(copy.folder)

    def test_the_bytes_are_those_that_the_seed_builds(self, copy):
        copy.save()
        with pytest.raises(StimulusError, match=r"pool\.json: expected the bytes"):
            check(copy.folder)


class TestScenes:
    def test_walls_are_those_of_the_maze(self, copy):
        name = copy.pool["scenarios"][0]["maze"]
        copy.pool["scenes"][name]["walls"].pop()
        copy.fails_with(f"scene {name}: expected the walls and areas of mazes/{name}.txt")

    def test_areas_are_those_of_the_maze(self, copy):
        name = copy.pool["scenarios"][0]["maze"]
        copy.pool["scenes"][name]["areas"]["A"] += 1
        copy.fails_with(f"scene {name}: expected the walls and areas")

    def test_every_maze_has_one(self, copy):
        copy.pool["scenes"]["more"] = copy.pool["scenes"]["practice"]
        copy.fails_with("one scene per maze file")


class TestMazes:
    def replace(self, copy, monkeypatch, name, maze):
        mazes = {**package_mazes(), name: maze}
        monkeypatch.setattr(pool_check, "package_mazes", lambda: mazes)
        copy.pool["scenes"][name] = scene(maze)

    def test_areas_do_not_touch(self, copy, monkeypatch):
        text = format_maze(package_mazes()["practice"])
        i, j = divmod(package_mazes()["practice"].goals["B"], 6)
        beside = (i, j + 1) if j < 5 else (i, j - 1)
        lines = [list(line) for line in text.replace("A", ".").splitlines()]
        lines[2 * beside[0] + 1][4 * beside[1] + 2] = "A"
        moved = parse_maze("\n".join("".join(line) for line in lines))
        self.replace(copy, monkeypatch, "practice", moved)
        copy.fails_with("areas A and B not to touch")

    def test_they_have_six_areas(self, copy, monkeypatch):
        fewer = parse_maze(format_maze(package_mazes()["practice"]).replace("F", "."))
        self.replace(copy, monkeypatch, "practice", fewer)
        copy.fails_with("practice: expected 6 goals")

    def test_they_have_their_size(self, copy, monkeypatch, draw_maze):
        self.replace(copy, monkeypatch, "practice", draw_maze(6, 7, 6))
        copy.fails_with("practice: expected 6 x 6 cells")

    def test_their_policies_are_certified(self, copy, monkeypatch):
        unguarded = Parameters(beta=50, gamma=0.01)
        monkeypatch.setattr("policies.pool_rule.PARAMETERS", unguarded)
        copy.fails_with("expected a certified legible policy")


class TestScenarios:
    def test_there_are_37(self, copy):
        copy.pool["scenarios"].pop()
        copy.fails_with("expected 37 scenarios")

    def test_their_ids_differ(self, copy):
        copy.pool["scenarios"][1]["id"] = "s01"
        copy.fails_with("expected 37 different scenarios")

    def test_they_differ(self, copy):
        first, second = copy.pool["scenarios"][:2]
        second.update(maze=first["maze"], start=first["start"], goal=first["goal"])
        copy.fails_with("expected 37 different scenarios")

    def test_none_starts_in_an_area(self, copy):
        first = copy.pool["scenarios"][0]
        first["start"] = copy.pool["scenes"][first["maze"]]["areas"]["C"]
        copy.fails_with("s01: expected a start outside the areas")

    @pytest.mark.parametrize("change", [{"maze": "practice"}, {"goal": "Q"}])
    def test_maze_and_goal_are_of_the_pool(self, copy, change):
        copy.pool["scenarios"][0].update(change)
        copy.fails_with("s01: expected a maze of the pool and one of its goals")

    def test_goals_are_in_equal_use(self, copy):
        moved = [s for s in copy.pool["scenarios"] if s["goal"] == "A"][:3]
        for s in moved:
            s["goal"] = "B"
        copy.fails_with("[AB]: expected within 1 of equal use")

    def test_mazes_are_in_equal_use(self, copy):
        used = [s["maze"] for s in copy.pool["scenarios"]]
        other = next(name for name in used if name != used[0])
        free = set(range(100)) - set(copy.pool["scenes"][other]["areas"].values())
        for s in [s for s in copy.pool["scenarios"] if s["maze"] == used[0]][:3]:
            taken = {(o["start"], o["goal"]) for o in copy.pool["scenarios"] if o["maze"] == other}
            start = next(x for x in sorted(free) if (x, s["goal"]) not in taken)
            s.update(maze=other, start=start)
        copy.fails_with("expected within 1 of equal use")


class TestStimuli:
    def test_every_condition_has_one(self, copy):
        copy.pool["stimuli"].pop()
        copy.fails_with("one rollout per scenario and condition")

    def test_no_condition_has_two(self, copy):
        copy.of("s01", "optimal")["condition"] = "polmdp"
        copy.fails_with("one rollout per scenario and condition")

    def test_they_start_where_their_scenario_does(self, copy):
        cells = copy.of("s01", "optimal")["cells"]
        cells[0] = cells[-1]
        copy.fails_with("expected maze, goal and start of scenario s01")

    def test_their_ids_are_hashes_of_their_content(self, copy):
        copy.of("s01", "optimal")["id"] = "0" * 12
        copy.fails_with("000000000000: expected the hash of its content", rename=False)

    def test_the_practice_id_is_a_hash_too(self, copy):
        copy.pool["practice"]["id"] = "0" * 12
        copy.fails_with("000000000000: expected the hash of its content", rename=False)

    def test_they_arrive(self, copy):
        copy.of("s01", "optimal")["cells"].pop()
        copy.fails_with("s01: expected both rollouts to end on entering the goal")

    def test_they_take_14_to_26_steps(self, copy):
        cells = copy.of("s01", "optimal")["cells"]
        cells[:0] = [cells[0]] * 20
        copy.fails_with("s01: expected 14 to 26 steps")

    def test_they_are_at_most_3_steps_apart(self, copy):
        pair = [copy.of("s01", condition)["cells"] for condition in ("polmdp", "optimal")]
        shorter, longer = sorted(pair, key=len)
        longer[:0] = [longer[0]] * (4 - len(longer) + len(shorter))
        copy.fails_with("s01: expected steps that differ by at most 3")

    def test_they_visit_different_cells(self, copy):
        copy.of("s01", "optimal")["cells"] = list(copy.of("s01", "polmdp")["cells"])
        copy.fails_with("s01: expected rollouts that differ in the cells")

    def test_their_steps_can_happen(self, copy):
        s = copy.of("s01", "optimal")
        cells, goal = s["cells"], s["cells"][-1]
        far = next(x for x in range(100) if x != goal and x not in cells)
        cells[5] = next(x for x in (0, 99, far) if abs(x - cells[4]) > 30 and x != goal)
        copy.fails_with(f"{cells[4]} to {cells[5]}")

    def test_they_are_the_draws_of_their_seed(self, copy):
        for s in copy.pool["stimuli"]:
            cells = s["cells"]
            stands = [k for k in range(1, len(cells)) if cells[k] == cells[k - 1]]
            if stands and cells[1] != cells[0]:
                # Failing at another time is as possible, but not what was drawn.
                cells.insert(0, cells[0])
                del cells[stands[0] + 1]
                break
        copy.fails_with("expected the draw of seed 2209")

    def test_another_seed_is_noticed(self, copy):
        copy.manifest["seed"] = 2210
        copy.fails_with("expected the draw of seed 2210")


class TestPractice:
    def test_takes_8_to_12_steps(self, copy):
        cells = copy.pool["practice"]["cells"]
        cells[:0] = [cells[0]] * 6
        copy.fails_with("practice: expected 8 to 12 steps")

    def test_has_a_maze_of_its_own(self, copy):
        copy.pool["practice"].update(copy.of("s01", "optimal"), scenario="practice")
        copy.fails_with("expected practice in maze practice")


class TestManifest:
    def test_belongs_to_the_pool(self, copy):
        copy.manifest["pool_sha256"] = "0" * 64
        copy.fails_with("expected the pool's hash")

    @pytest.mark.parametrize("key", ["parameters", "rule", "mazes_sha256", "steps_until_sure"])
    def test_every_part_comes_out_again(self, copy, key):
        copy.manifest[key] = copy.manifest[key][:-1] if key in ("rule", "steps_until_sure") else {}
        copy.fails_with(f"expected {key} as recomputed")

    def test_belief_curves_come_out_again(self, copy):
        key = copy.pool["stimuli"][0]["id"]
        copy.manifest["belief_in_true_goal"][key][3] += 0.00001
        copy.fails_with("expected belief_in_true_goal as recomputed")

    def test_the_prediction_comes_out_again(self, copy):
        copy.manifest["prediction"]["saving_steps"]["mean"] += 1
        copy.fails_with("expected prediction as recomputed")

    def test_holds_nothing_else(self, copy):
        copy.manifest["note"] = "x"
        copy.fails_with("expected no other entries")

    def test_a_pool_that_does_not_tell_sooner_is_refused(self, copy):
        given = pool_check._read(copy.folder)
        prediction = given.manifest["prediction"]
        prediction["baseline_steps"]["high"] = prediction["saving_steps"]["low"]
        with pytest.raises(StimulusError, match="the mazes need another design"):
            pool_check._tells_sooner(given)
