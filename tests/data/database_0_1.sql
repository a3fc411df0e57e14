BEGIN TRANSACTION;
CREATE TABLE classes (
	id VARCHAR(40) NOT NULL, 
	code VARCHAR(8) NOT NULL, 
	touched DOUBLE NOT NULL, 
	changes INTEGER NOT NULL, 
	joined INTEGER NOT NULL, 
	frozen INTEGER NOT NULL, 
	pushes INTEGER NOT NULL, 
	push TEXT NOT NULL, 
	PRIMARY KEY (id)
);
INSERT INTO "classes" VALUES('1e01d63bbf30f65a6c230e9f626153b869acc2b3','33j4',1800000000.0,3,2,0,0,'');
CREATE TABLE labs (
	code VARCHAR(64) NOT NULL, 
	version INTEGER NOT NULL, 
	updated DOUBLE NOT NULL, 
	state TEXT NOT NULL, 
	PRIMARY KEY (code)
);
INSERT INTO "labs" VALUES('c0de01',1,1800000000.0,'{"setup":{"benches":{"five_bar":{"parameters":{"K1":900.0},"path":{"name":"clover"}}}}}');
INSERT INTO "labs" VALUES('c0de02',1,1800000000.0,'{"setup":{"benches":{"five_bar":{"parameters":{"K2":11.0}}}}}');
INSERT INTO "labs" VALUES('c0de03',1,1800000000.0,'{"setup":{"benches":{"five_bar":{"parameters":{"K2":12.0}}}}}');
CREATE TABLE leases (
	code VARCHAR(64) NOT NULL, 
	owner VARCHAR(40) NOT NULL, 
	expires DOUBLE NOT NULL, 
	PRIMARY KEY (code)
);
INSERT INTO "leases" VALUES('c0de01','d7cffbc6c7bf4ea8b7bda7ea5362c051',1800000004.0);
INSERT INTO "leases" VALUES('c0de02','d7cffbc6c7bf4ea8b7bda7ea5362c051',1800000004.0);
CREATE TABLE members (
	class_id VARCHAR(40) NOT NULL, 
	session VARCHAR(64) NOT NULL, 
	changed INTEGER NOT NULL, 
	number INTEGER NOT NULL, 
	name VARCHAR(100) NOT NULL, 
	active DOUBLE NOT NULL, 
	taken INTEGER NOT NULL, 
	progress TEXT NOT NULL, 
	PRIMARY KEY (class_id, session)
);
INSERT INTO "members" VALUES('1e01d63bbf30f65a6c230e9f626153b869acc2b3','c0de01',3,1,'Ada',1800000000.0,0,'{"lesson":"one","language":"en","presenting":false,"notes":{"one":{"step":0,"seen":0,"answers":{"1":{"option":1,"times":[],"values":[]}},"truths":{},"played":[],"tasks":{},"hints":{},"quiz":{}}}}');
INSERT INTO "members" VALUES('1e01d63bbf30f65a6c230e9f626153b869acc2b3','c0de02',3,2,'Bob <b>',1800000000.0,0,'{"lesson":"","language":"en","presenting":false,"notes":{}}');
CREATE TABLE meta (
	name VARCHAR(40) NOT NULL, 
	number INTEGER NOT NULL, 
	PRIMARY KEY (name)
);
INSERT INTO "meta" VALUES('version',1);
CREATE TABLE passes (
	class_id VARCHAR(40) NOT NULL, 
	hash VARCHAR(64) NOT NULL, 
	PRIMARY KEY (class_id, hash)
);
CREATE TABLE watches (
	class_id VARCHAR(40) NOT NULL, 
	session VARCHAR(64) NOT NULL, 
	until DOUBLE NOT NULL, 
	moment TEXT NOT NULL, 
	PRIMARY KEY (class_id, session)
);
COMMIT;
