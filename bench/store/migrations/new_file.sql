CREATE TABLE alembic_version (
	version_num VARCHAR(32) NOT NULL, 
	CONSTRAINT alembic_version_pkc PRIMARY KEY (version_num)
)

CREATE TABLE experiment (
	id INTEGER NOT NULL, 
	kind TEXT NOT NULL, 
	parameters JSON NOT NULL, 
	source TEXT NOT NULL, 
	operator TEXT NOT NULL, 
	note TEXT NOT NULL, 
	provenance JSON NOT NULL, 
	rig JSON NOT NULL, 
	owner TEXT, 
	started_utc DATETIME NOT NULL, 
	finished_utc DATETIME, 
	outcome TEXT NOT NULL, 
	reason TEXT NOT NULL, 
	results JSON NOT NULL, bench TEXT, software_version TEXT, software_commit TEXT, drive TEXT, firmware TEXT, seed BIGINT, 
	CONSTRAINT pk_experiment PRIMARY KEY (id)
)

CREATE TABLE trial (
	id INTEGER NOT NULL, 
	experiment_id INTEGER NOT NULL, 
	name TEXT NOT NULL, 
	kind TEXT NOT NULL, 
	channels JSON NOT NULL, 
	rows INTEGER NOT NULL, 
	started_utc DATETIME NOT NULL, 
	finished_utc DATETIME, 
	outcome TEXT NOT NULL, 
	reason TEXT NOT NULL, 
	results JSON NOT NULL, 
	CONSTRAINT pk_trial PRIMARY KEY (id), 
	CONSTRAINT fk_trial_experiment_id FOREIGN KEY(experiment_id) REFERENCES experiment (id) ON DELETE CASCADE, 
	CONSTRAINT uq_trial_experiment_id_name UNIQUE (experiment_id, name)
)

CREATE TABLE trial_condition (
	trial_id INTEGER NOT NULL, 
	"key" TEXT NOT NULL, 
	position INTEGER NOT NULL, 
	number FLOAT, 
	text TEXT, 
	flag BOOLEAN, 
	CONSTRAINT pk_trial_condition PRIMARY KEY (trial_id, "key"), 
	CONSTRAINT fk_trial_condition_trial_id FOREIGN KEY(trial_id) REFERENCES trial (id) ON DELETE CASCADE
)

CREATE TABLE sample_block (
	trial_id INTEGER NOT NULL, 
	first_row INTEGER NOT NULL, 
	rows INTEGER NOT NULL, 
	data BLOB NOT NULL, crc32 BIGINT, 
	CONSTRAINT pk_sample_block PRIMARY KEY (trial_id, first_row), 
	CONSTRAINT fk_sample_block_trial_id FOREIGN KEY(trial_id) REFERENCES trial (id) ON DELETE CASCADE
)

CREATE TABLE event (
	id INTEGER NOT NULL, 
	trial_id INTEGER NOT NULL, 
	time_s FLOAT NOT NULL, 
	name TEXT NOT NULL, 
	detail TEXT NOT NULL, 
	CONSTRAINT pk_event PRIMARY KEY (id), 
	CONSTRAINT fk_event_trial_id FOREIGN KEY(trial_id) REFERENCES trial (id) ON DELETE CASCADE
)

CREATE TABLE study (
	id INTEGER NOT NULL, 
	name TEXT NOT NULL, 
	definition JSON NOT NULL, 
	created_utc DATETIME NOT NULL, 
	CONSTRAINT pk_study PRIMARY KEY (id)
)

CREATE TABLE model (
	id INTEGER NOT NULL, 
	study_id INTEGER NOT NULL, 
	parent_id INTEGER, 
	effects JSON NOT NULL, 
	result JSON NOT NULL, 
	created_utc DATETIME NOT NULL, 
	CONSTRAINT pk_model PRIMARY KEY (id), 
	CONSTRAINT fk_model_study_id FOREIGN KEY(study_id) REFERENCES study (id) ON DELETE CASCADE, 
	CONSTRAINT fk_model_parent_id FOREIGN KEY(parent_id) REFERENCES model (id)
)

CREATE TABLE calibration (
	id INTEGER NOT NULL, 
	note TEXT NOT NULL, 
	source TEXT NOT NULL, 
	rig JSON NOT NULL, 
	drive JSON NOT NULL, 
	provenance JSON NOT NULL, 
	experiment_ids JSON NOT NULL, 
	trial_ids JSON NOT NULL, 
	result JSON NOT NULL, 
	created_utc DATETIME NOT NULL, 
	chosen_utc DATETIME, 
	CONSTRAINT pk_calibration PRIMARY KEY (id)
)

CREATE TABLE sample_overview (
	trial_id INTEGER NOT NULL, 
	first_row INTEGER NOT NULL, 
	rows INTEGER NOT NULL, 
	data BLOB NOT NULL, crc32 BIGINT, 
	CONSTRAINT pk_sample_overview PRIMARY KEY (trial_id, first_row), 
	CONSTRAINT fk_sample_overview_trial_id FOREIGN KEY(trial_id) REFERENCES trial (id) ON DELETE CASCADE
)

CREATE TABLE access_token (
	id INTEGER NOT NULL, 
	name TEXT NOT NULL, 
	role TEXT NOT NULL, 
	digest TEXT NOT NULL, 
	created_utc DATETIME NOT NULL, 
	expires_utc DATETIME, 
	revoked_utc DATETIME, 
	CONSTRAINT pk_access_token PRIMARY KEY (id), 
	CONSTRAINT uq_access_token_name UNIQUE (name), 
	CONSTRAINT uq_access_token_digest UNIQUE (digest)
)

CREATE TABLE audit (
	id INTEGER NOT NULL, 
	at_utc DATETIME NOT NULL, 
	token TEXT NOT NULL, 
	role TEXT NOT NULL, 
	client TEXT NOT NULL, 
	method TEXT NOT NULL, 
	path TEXT NOT NULL, 
	status INTEGER NOT NULL, 
	detail TEXT NOT NULL, 
	CONSTRAINT pk_audit PRIMARY KEY (id)
)

CREATE TABLE start_key (
	id INTEGER NOT NULL, 
	"key" TEXT NOT NULL, 
	token TEXT NOT NULL, 
	body_digest TEXT NOT NULL, 
	status INTEGER, 
	answer JSON, 
	created_utc DATETIME NOT NULL, 
	CONSTRAINT pk_start_key PRIMARY KEY (id), 
	CONSTRAINT uq_start_key_token_key UNIQUE (token, "key")
)

CREATE TABLE campaign (
	id INTEGER NOT NULL, 
	name TEXT NOT NULL, 
	definition JSON NOT NULL, 
	operator TEXT NOT NULL, 
	note TEXT NOT NULL, 
	tags JSON NOT NULL, 
	created_utc DATETIME NOT NULL, 
	CONSTRAINT pk_campaign PRIMARY KEY (id)
)

CREATE TABLE queue_item (
	id INTEGER NOT NULL, 
	bench TEXT NOT NULL, 
	campaign_id INTEGER, 
	place INTEGER NOT NULL, 
	kind TEXT NOT NULL, 
	parameters JSON NOT NULL, 
	operator TEXT NOT NULL, 
	note TEXT NOT NULL, 
	tags JSON NOT NULL, 
	pace TEXT, 
	duration_s FLOAT NOT NULL, 
	loads JSON NOT NULL, 
	state TEXT NOT NULL, 
	reason TEXT NOT NULL, 
	experiment_id INTEGER, 
	created_utc DATETIME NOT NULL, 
	finished_utc DATETIME, lab_claim TEXT, owner TEXT, 
	CONSTRAINT pk_queue_item PRIMARY KEY (id), 
	CONSTRAINT fk_queue_item_campaign_id FOREIGN KEY(campaign_id) REFERENCES campaign (id) ON DELETE CASCADE
)

CREATE TABLE queue_state (
	bench TEXT NOT NULL, 
	held BOOLEAN NOT NULL, 
	reason TEXT NOT NULL, 
	changed_utc DATETIME NOT NULL, 
	CONSTRAINT pk_queue_state PRIMARY KEY (bench)
)

CREATE TABLE experiment_tag (
	experiment_id INTEGER NOT NULL, 
	tag TEXT NOT NULL, 
	CONSTRAINT pk_experiment_tag PRIMARY KEY (experiment_id, tag), 
	CONSTRAINT fk_experiment_tag_experiment_id FOREIGN KEY(experiment_id) REFERENCES experiment (id) ON DELETE CASCADE
)

CREATE TABLE chain (
	id INTEGER NOT NULL, 
	at_utc DATETIME NOT NULL, 
	subject TEXT NOT NULL, 
	row_id INTEGER NOT NULL, 
	state TEXT NOT NULL, 
	digest TEXT NOT NULL, 
	link TEXT NOT NULL, 
	CONSTRAINT pk_chain PRIMARY KEY (id)
)

CREATE TABLE handed_in (
	bench TEXT NOT NULL, 
	origin_id INTEGER NOT NULL, 
	started_utc DATETIME NOT NULL, 
	experiment_id INTEGER NOT NULL, 
	complete BOOLEAN NOT NULL, 
	CONSTRAINT pk_handed_in PRIMARY KEY (bench, origin_id, started_utc)
)

CREATE TABLE bench (
	name TEXT NOT NULL, 
	host TEXT NOT NULL, 
	state TEXT NOT NULL, 
	doing TEXT NOT NULL, 
	lease TEXT NOT NULL, 
	queue TEXT NOT NULL, 
	waiting INTEGER NOT NULL, 
	seen_utc DATETIME NOT NULL, 
	CONSTRAINT pk_bench PRIMARY KEY (name)
)

CREATE TABLE lab_item (
	id INTEGER NOT NULL, 
	kind TEXT NOT NULL, 
	operator TEXT NOT NULL, 
	note TEXT NOT NULL, 
	asked_by TEXT NOT NULL, 
	for_bench TEXT NOT NULL, 
	for_rig TEXT NOT NULL, 
	state TEXT NOT NULL, 
	reason TEXT NOT NULL, 
	bench TEXT NOT NULL, 
	claim TEXT NOT NULL, 
	parameters JSON NOT NULL, 
	tags JSON NOT NULL, 
	for_tags JSON NOT NULL, 
	declined JSON NOT NULL, 
	pace TEXT, 
	origin_id INTEGER, 
	created_utc DATETIME NOT NULL, 
	renewed_utc DATETIME, 
	finished_utc DATETIME, 
	CONSTRAINT pk_lab_item PRIMARY KEY (id)
)

CREATE INDEX ix_experiment_outcome ON experiment (outcome)

CREATE INDEX ix_experiment_kind ON experiment (kind)

CREATE INDEX ix_event_trial_id_time_s ON event (trial_id, time_s)

CREATE INDEX ix_model_study_id ON model (study_id)

CREATE INDEX ix_model_parent_id ON model (parent_id)

CREATE INDEX ix_trial_kind_outcome_experiment_id ON trial (kind, outcome, experiment_id)

CREATE INDEX ix_trial_outcome_experiment_id ON trial (outcome, experiment_id)

CREATE INDEX ix_trial_experiment_id_outcome_kind ON trial (experiment_id, outcome, kind)

CREATE INDEX ix_trial_condition_key_number_trial_id ON trial_condition ("key", number, trial_id)

CREATE INDEX ix_trial_condition_key_text_trial_id ON trial_condition ("key", text, trial_id)

CREATE INDEX ix_trial_condition_key_flag_trial_id ON trial_condition ("key", flag, trial_id)

CREATE VIEW experiment_view AS
SELECT e.id AS experiment_id, e.kind, e.source, e.operator, e.note, e.bench, e.drive, e.firmware, e.seed,
       e.software_version, e.software_commit, e.started_utc, e.finished_utc, e.outcome, e.reason,
       (SELECT count(*) FROM trial t WHERE t.experiment_id = e.id) AS trials,
       (SELECT coalesce(sum(t.rows), 0) FROM trial t WHERE t.experiment_id = e.id) AS rows
FROM experiment e
WHERE e.outcome NOT IN ('importing', 'removing')

CREATE VIEW trial_view AS
SELECT t.id AS trial_id, t.experiment_id, t.name, t.kind, t.started_utc, t.finished_utc, t.outcome, t.reason, t.rows,
       (SELECT c.number FROM trial_condition c WHERE c.trial_id = t.id AND c.key = 'load_kg') AS load_kg,
       (SELECT c.number FROM trial_condition c WHERE c.trial_id = t.id AND c.key = 'arm_m') AS arm_m,
       (SELECT c.number FROM trial_condition c WHERE c.trial_id = t.id AND c.key = 'supply_v') AS supply_v,
       (SELECT c.number FROM trial_condition c WHERE c.trial_id = t.id AND c.key = 'temperature_c') AS temperature_c,
       (SELECT c.number FROM trial_condition c WHERE c.trial_id = t.id AND c.key = 'speed_rad_s') AS speed_rad_s,
       (SELECT c.number FROM trial_condition c WHERE c.trial_id = t.id AND c.key = 'repeat') AS repeat,
       (SELECT c.flag FROM trial_condition c WHERE c.trial_id = t.id AND c.key = 'balanced') AS balanced,
       e.source, e.operator, e.bench, e.drive
FROM trial t JOIN experiment e ON e.id = t.experiment_id
WHERE e.outcome NOT IN ('importing', 'removing')

CREATE INDEX ix_audit_at_utc ON audit (at_utc)

CREATE INDEX ix_audit_token ON audit (token)

CREATE INDEX ix_start_key_created_utc ON start_key (created_utc)

CREATE INDEX ix_queue_item_bench_state_place ON queue_item (bench, state, place)

CREATE INDEX ix_queue_item_campaign_id ON queue_item (campaign_id)

CREATE INDEX ix_experiment_tag_tag_experiment_id ON experiment_tag (tag, experiment_id)

CREATE INDEX ix_lab_item_state ON lab_item (state)
