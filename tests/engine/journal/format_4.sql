-- What version 4 of the format wrote: `written` of test_damage.py, before events were kept in blocks.
BEGIN TRANSACTION;
CREATE TABLE checksum(
    run TEXT PRIMARY KEY, since INTEGER NOT NULL, seq INTEGER NOT NULL, chain BLOB, record BLOB, origin BLOB,
    world BLOB) STRICT, WITHOUT ROWID;
INSERT INTO "checksum" VALUES('first',1,20,X'9518B458FF5CD28159A2775899D35ED2',X'0517EB37C6F52B93AAB35EBD6DC202A8',X'B3043AB794F4B6F74DA9BE77BA250C19',X'0D12605BC6D62977487419F894ED3F68');
INSERT INTO "checksum" VALUES('second',1,20,X'481DE37DAFE9F15F2E18A11189D95CD9',X'89A2F562745D329F0DDF214AB407254C',X'B93DC0C543BB8EFE1CF8158748D5E9FC',X'88CF8912E7B54B893C32A675A19DB91C');
CREATE TABLE driver(run TEXT PRIMARY KEY, engine TEXT NOT NULL) STRICT;
INSERT INTO "driver" VALUES('first','0123456789abcdef');
INSERT INTO "driver" VALUES('second','0123456789abcdef');
CREATE TABLE event(
    run TEXT NOT NULL, seq INTEGER NOT NULL, time_s REAL NOT NULL, epoch INTEGER NOT NULL, data TEXT NOT NULL, checksum BLOB,
    PRIMARY KEY (run, seq)) STRICT, WITHOUT ROWID;
INSERT INTO "event" VALUES('first',1,0.5,1,'{"event":"log","seq":1,"time_s":0.5,"path":"root","level":"info","message":"step 1 xxxxxxx"}',X'4880FFB4ABD0C7C280036A2AD11ADC19');
INSERT INTO "event" VALUES('first',2,1.0,1,'{"event":"log","seq":2,"time_s":1.0,"path":"root","level":"info","message":"step 2 xxxxxxxxxxxxxx"}',X'4861EEF24609C42A05CECCB836A32280');
INSERT INTO "event" VALUES('first',3,1.5,1,'{"event":"log","seq":3,"time_s":1.5,"path":"root","level":"info","message":"step 3 xxxxxxxxxxxxxxxxxxxxx"}',X'89AC2F58F59E9A98D5F094F1205E0062');
INSERT INTO "event" VALUES('first',4,2.0,1,'{"event":"log","seq":4,"time_s":2.0,"path":"root","level":"info","message":"step 4 xxxxxxxxxxxxxxxxxxxxxxxxxxxx"}',X'651F82313F80066F2F18187C463723E7');
INSERT INTO "event" VALUES('first',5,2.5,1,'{"event":"log","seq":5,"time_s":2.5,"path":"root","level":"info","message":"step 5 xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx"}',X'9C5AA5428350004270421679C179AD24');
INSERT INTO "event" VALUES('first',6,3.0,1,'{"event":"log","seq":6,"time_s":3.0,"path":"root","level":"info","message":"step 6 xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx"}',X'FCDBE58BDBAB05074063DC8D38326419');
INSERT INTO "event" VALUES('first',7,3.5,1,'{"event":"log","seq":7,"time_s":3.5,"path":"root","level":"info","message":"step 7 xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx"}',X'37B00566488C28D05D350AEBAFD7307B');
INSERT INTO "event" VALUES('first',8,4.0,1,'{"event":"log","seq":8,"time_s":4.0,"path":"root","level":"info","message":"step 8 xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx"}',X'98881627F0B9714B372E97A390D1EA72');
INSERT INTO "event" VALUES('first',9,4.5,1,'{"event":"log","seq":9,"time_s":4.5,"path":"root","level":"info","message":"step 9 xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx"}',X'8C8FB1E9BF1C629544D1F6778AE6485F');
INSERT INTO "event" VALUES('first',10,5.0,1,'{"event":"log","seq":10,"time_s":5.0,"path":"root","level":"info","message":"step 10 xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx"}',X'47E7EF93904E5F56E59959FC933FB6A7');
INSERT INTO "event" VALUES('first',11,5.5,1,'{"event":"log","seq":11,"time_s":5.5,"path":"root","level":"info","message":"step 11 xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx"}',X'8B2F553E713B43DAE4C6995F3A07AC82');
INSERT INTO "event" VALUES('first',12,6.0,1,'{"event":"log","seq":12,"time_s":6.0,"path":"root","level":"info","message":"step 12 xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx"}',X'455CFFA1B7CE6A48081FAA12FB38EEB7');
INSERT INTO "event" VALUES('first',13,6.5,1,'{"event":"log","seq":13,"time_s":6.5,"path":"root","level":"info","message":"step 13 xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx"}',X'24EBA08EBCAC3C11B86B2F456CFA7F2E');
INSERT INTO "event" VALUES('first',14,7.0,1,'{"event":"log","seq":14,"time_s":7.0,"path":"root","level":"info","message":"step 14 xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx"}',X'9B109940A7660AB7B8BF38CB4AFDC3AA');
INSERT INTO "event" VALUES('first',15,7.5,1,'{"event":"log","seq":15,"time_s":7.5,"path":"root","level":"info","message":"step 15 xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx"}',X'80897785A6001B926B66D0C65F0CFE99');
INSERT INTO "event" VALUES('first',16,8.0,1,'{"event":"log","seq":16,"time_s":8.0,"path":"root","level":"info","message":"step 16 xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx"}',X'4798FD3D57BDF66D56F50ED8DEC16D39');
INSERT INTO "event" VALUES('first',17,8.5,1,'{"event":"log","seq":17,"time_s":8.5,"path":"root","level":"info","message":"step 17 xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx"}',X'BC1FE904CCA007DE20D1C292E4C01508');
INSERT INTO "event" VALUES('first',18,9.0,1,'{"event":"log","seq":18,"time_s":9.0,"path":"root","level":"info","message":"step 18 xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx"}',X'4981A3897311628BDA309C4E7DE80349');
INSERT INTO "event" VALUES('first',19,9.5,1,'{"event":"log","seq":19,"time_s":9.5,"path":"root","level":"info","message":"step 19 xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx"}',X'4ED946F1B113CE9E98BBE99554E1575B');
INSERT INTO "event" VALUES('first',20,30.0,1,'{"event":"run_ended","seq":20,"time_s":30.0,"status":"finished","outcome":"done"}',X'9518B458FF5CD28159A2775899D35ED2');
INSERT INTO "event" VALUES('second',1,0.5,1,'{"event":"log","seq":1,"time_s":0.5,"path":"root","level":"info","message":"step 1 xxxxxxx"}',X'618CCB410693B3C6E7F8294FB4122508');
INSERT INTO "event" VALUES('second',2,1.0,1,'{"event":"log","seq":2,"time_s":1.0,"path":"root","level":"info","message":"step 2 xxxxxxxxxxxxxx"}',X'A99839FBE259A38A49A366F5B7E4CFF6');
INSERT INTO "event" VALUES('second',3,1.5,1,'{"event":"log","seq":3,"time_s":1.5,"path":"root","level":"info","message":"step 3 xxxxxxxxxxxxxxxxxxxxx"}',X'68EA7D1D8D347CC6D1359CD959DCA821');
INSERT INTO "event" VALUES('second',4,2.0,1,'{"event":"log","seq":4,"time_s":2.0,"path":"root","level":"info","message":"step 4 xxxxxxxxxxxxxxxxxxxxxxxxxxxx"}',X'AB1585616381E4531080245CB0B2AB99');
INSERT INTO "event" VALUES('second',5,2.5,1,'{"event":"log","seq":5,"time_s":2.5,"path":"root","level":"info","message":"step 5 xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx"}',X'2634A148EC805B9D4E0586FF6942AF77');
INSERT INTO "event" VALUES('second',6,3.0,1,'{"event":"log","seq":6,"time_s":3.0,"path":"root","level":"info","message":"step 6 xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx"}',X'E40030CB98931AF2512CB09DFAF69E50');
INSERT INTO "event" VALUES('second',7,3.5,1,'{"event":"log","seq":7,"time_s":3.5,"path":"root","level":"info","message":"step 7 xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx"}',X'21884C1D53B8367DF5952100C26445A8');
INSERT INTO "event" VALUES('second',8,4.0,1,'{"event":"log","seq":8,"time_s":4.0,"path":"root","level":"info","message":"step 8 xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx"}',X'408E485543BAD4131184C4D0692FCB8D');
INSERT INTO "event" VALUES('second',9,4.5,1,'{"event":"log","seq":9,"time_s":4.5,"path":"root","level":"info","message":"step 9 xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx"}',X'60C20ACF3FAEC10CBADE0CCC38A3F834');
INSERT INTO "event" VALUES('second',10,5.0,1,'{"event":"log","seq":10,"time_s":5.0,"path":"root","level":"info","message":"step 10 xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx"}',X'B5809536BF2AF8EFA65CA8E2E1129B27');
INSERT INTO "event" VALUES('second',11,5.5,1,'{"event":"log","seq":11,"time_s":5.5,"path":"root","level":"info","message":"step 11 xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx"}',X'54CD0B74F4C99915837AF454511250AB');
INSERT INTO "event" VALUES('second',12,6.0,1,'{"event":"log","seq":12,"time_s":6.0,"path":"root","level":"info","message":"step 12 xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx"}',X'E358FAE9DE44D05500F55C60CA003A4C');
INSERT INTO "event" VALUES('second',13,6.5,1,'{"event":"log","seq":13,"time_s":6.5,"path":"root","level":"info","message":"step 13 xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx"}',X'FBC35CA6B8E2987CCF8554AE04A50B53');
INSERT INTO "event" VALUES('second',14,7.0,1,'{"event":"log","seq":14,"time_s":7.0,"path":"root","level":"info","message":"step 14 xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx"}',X'C329D26C7C89FEBC6C4F573F4AE4B4B8');
INSERT INTO "event" VALUES('second',15,7.5,1,'{"event":"log","seq":15,"time_s":7.5,"path":"root","level":"info","message":"step 15 xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx"}',X'D9712E180E18BAE9D1BD4A62FB52884E');
INSERT INTO "event" VALUES('second',16,8.0,1,'{"event":"log","seq":16,"time_s":8.0,"path":"root","level":"info","message":"step 16 xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx"}',X'B59B8EC3CA553581AE96E6A91BAFC5B1');
INSERT INTO "event" VALUES('second',17,8.5,1,'{"event":"log","seq":17,"time_s":8.5,"path":"root","level":"info","message":"step 17 xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx"}',X'095F2392FC7BE48BC4F3B40073D15BA4');
INSERT INTO "event" VALUES('second',18,9.0,1,'{"event":"log","seq":18,"time_s":9.0,"path":"root","level":"info","message":"step 18 xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx"}',X'8D0F3A9A957BA3D9BB5B57F0E7DE6A53');
INSERT INTO "event" VALUES('second',19,9.5,1,'{"event":"log","seq":19,"time_s":9.5,"path":"root","level":"info","message":"step 19 xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx"}',X'6626AF543BF48658E0C8F94C403C529B');
INSERT INTO "event" VALUES('second',20,30.0,1,'{"event":"run_ended","seq":20,"time_s":30.0,"status":"finished","outcome":"done"}',X'481DE37DAFE9F15F2E18A11189D95CD9');
CREATE TABLE origin(run TEXT PRIMARY KEY, data TEXT NOT NULL) STRICT;
INSERT INTO "origin" VALUES('first','{"behavior":"/b.yaml","documents":{"b.yaml":"text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text "}}');
INSERT INTO "origin" VALUES('second','{"behavior":"/b.yaml","documents":{"b.yaml":"text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text text "}}');
CREATE TABLE run(
    id TEXT PRIMARY KEY, behavior TEXT NOT NULL, hash TEXT NOT NULL, status TEXT NOT NULL,
    epoch INTEGER NOT NULL, started REAL NOT NULL) STRICT;
INSERT INTO "run" VALUES('first','transfer','abc','finished',1,10.0);
INSERT INTO "run" VALUES('second','transfer','abc','finished',1,10.0);
CREATE TABLE world(run TEXT PRIMARY KEY, seq INTEGER NOT NULL, data BLOB NOT NULL) STRICT;
INSERT INTO "world" VALUES('first',19,X'000102030405060708090A0B0C0D0E0F101112131415161718191A1B1C1D1E1F202122232425262728292A2B2C2D2E2F303132333435363738393A3B3C3D3E3F404142434445464748494A4B4C4D4E4F505152535455565758595A5B5C5D5E5F60616263');
INSERT INTO "world" VALUES('second',19,X'000102030405060708090A0B0C0D0E0F101112131415161718191A1B1C1D1E1F202122232425262728292A2B2C2D2E2F303132333435363738393A3B3C3D3E3F404142434445464748494A4B4C4D4E4F505152535455565758595A5B5C5D5E5F60616263');
COMMIT;
PRAGMA user_version=4;
