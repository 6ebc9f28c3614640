	switch (t->back) {
	default: Uerror("bad return move");
	case  0: goto R999; /* nothing to undo */

		 /* PROC scheduler */
;
		;
		
	case 4: // STATE 2
		;
		now.loom_go = trpt->bup.oval;
		;
		goto R999;

	case 5: // STATE 6
		;
		p_restor(II);
		;
		;
		goto R999;

		 /* PROC activity_world */
;
		;
		;
		;
		;
		;
		
	case 9: // STATE 4
		;
		_m = unsend(now.loom_events);
		;
		goto R999;
;
		;
		;
		;
		;
		;
		
	case 13: // STATE 14
		;
		_m = unsend(now.loom_events);
		;
		goto R999;
;
		;
		;
		;
		;
		;
		
	case 17: // STATE 24
		;
		_m = unsend(now.loom_events);
		;
		goto R999;
;
		;
		;
		;
		;
		;
		
	case 21: // STATE 34
		;
		_m = unsend(now.loom_events);
		;
		goto R999;
;
		;
		;
		;
		;
		;
		
	case 25: // STATE 44
		;
		_m = unsend(now.loom_events);
		;
		goto R999;
;
		;
		;
		;
		;
		;
		
	case 29: // STATE 54
		;
		_m = unsend(now.loom_events);
		;
		goto R999;
;
		;
		;
		;
		;
		;
		
	case 33: // STATE 64
		;
		_m = unsend(now.loom_events);
		;
		goto R999;
;
		;
		;
		;
		;
		;
		
	case 37: // STATE 74
		;
		_m = unsend(now.loom_events);
		;
		goto R999;

	case 38: // STATE 84
		;
		p_restor(II);
		;
		;
		goto R999;

		 /* PROC machine_loom */

	case 39: // STATE 1
		;
		now.loom_r0 = trpt->bup.oval;
		;
		goto R999;

	case 40: // STATE 2
		;
		now.loom_r1 = trpt->bup.oval;
		;
		goto R999;

	case 41: // STATE 3
		;
		now.loom_started = trpt->bup.oval;
		;
		goto R999;
;
		;
		;
		;
		;
		;
		;
		;
		;
		;
		;
		;
		;
		;
		;
		;
		;
		;
		;
		;
		;
		;
		;
		;
		;
		;
		
	case 55: // STATE 73
		;
		now.loom_r2 = trpt->bup.oval;
		;
		goto R999;

	case 56: // STATE 78
		;
		now.loom_r1 = trpt->bup.oval;
		;
		goto R999;

	case 57: // STATE 79
		;
		now.loom_r1 = trpt->bup.oval;
		;
		goto R999;
;
		;
		;
		;
		
	case 60: // STATE 83
		;
		now.loom_r2 = trpt->bup.oval;
		;
		goto R999;

	case 61: // STATE 88
		;
		now.loom_r1 = trpt->bup.oval;
		;
		goto R999;

	case 62: // STATE 89
		;
		now.loom_r1 = trpt->bup.oval;
		;
		goto R999;
;
		;
		
	case 64: // STATE 92
		;
		now.loom_r2 = trpt->bup.oval;
		;
		goto R999;

	case 65: // STATE 93
		;
		now.loom_r2 = trpt->bup.oval;
		;
		goto R999;
;
		;
		;
		;
		;
		;
		
	case 69: // STATE 98
		;
		now.loom_r2 = trpt->bup.oval;
		;
		goto R999;

	case 70: // STATE 103
		;
		now.loom_r1 = trpt->bup.oval;
		;
		goto R999;

	case 71: // STATE 108
		;
		now.loom_r0 = trpt->bup.oval;
		;
		goto R999;

	case 72: // STATE 109
		;
		now.loom_r0 = trpt->bup.oval;
		;
		goto R999;
;
		;
		;
		;
		;
		;
		
	case 76: // STATE 114
		;
		now.loom_r2 = trpt->bup.oval;
		;
		goto R999;

	case 77: // STATE 119
		;
		now.loom_r1 = trpt->bup.oval;
		;
		goto R999;

	case 78: // STATE 124
		;
		now.loom_r0 = trpt->bup.oval;
		;
		goto R999;

	case 79: // STATE 125
		;
		now.loom_r0 = trpt->bup.oval;
		;
		goto R999;
;
		;
		;
		;
		;
		;
		
	case 83: // STATE 130
		;
		now.loom_r2 = trpt->bup.oval;
		;
		goto R999;

	case 84: // STATE 135
		;
		now.loom_r1 = trpt->bup.oval;
		;
		goto R999;

	case 85: // STATE 140
		;
		now.loom_r0 = trpt->bup.oval;
		;
		goto R999;

	case 86: // STATE 141
		;
		now.loom_r0 = trpt->bup.oval;
		;
		goto R999;
;
		;
		;
		;
		;
		;
		
	case 90: // STATE 146
		;
		now.loom_r2 = trpt->bup.oval;
		;
		goto R999;

	case 91: // STATE 151
		;
		now.loom_r1 = trpt->bup.oval;
		;
		goto R999;

	case 92: // STATE 156
		;
		now.loom_r0 = trpt->bup.oval;
		;
		goto R999;

	case 93: // STATE 157
		;
		now.loom_r0 = trpt->bup.oval;
		;
		goto R999;
;
		;
		;
		;
		;
		;
		
	case 97: // STATE 162
		;
		now.loom_r2 = trpt->bup.oval;
		;
		goto R999;

	case 98: // STATE 167
		;
		now.loom_r1 = trpt->bup.oval;
		;
		goto R999;

	case 99: // STATE 172
		;
		now.loom_r0 = trpt->bup.oval;
		;
		goto R999;

	case 100: // STATE 173
		;
		now.loom_r0 = trpt->bup.oval;
		;
		goto R999;
;
		;
		;
		;
		;
		;
		
	case 104: // STATE 178
		;
		now.loom_r2 = trpt->bup.oval;
		;
		goto R999;

	case 105: // STATE 183
		;
		now.loom_r1 = trpt->bup.oval;
		;
		goto R999;

	case 106: // STATE 188
		;
		now.loom_r0 = trpt->bup.oval;
		;
		goto R999;

	case 107: // STATE 189
		;
		now.loom_r0 = trpt->bup.oval;
		;
		goto R999;
;
		;
		;
		;
		;
		;
		
	case 111: // STATE 194
		;
		now.loom_r2 = trpt->bup.oval;
		;
		goto R999;

	case 112: // STATE 199
		;
		now.loom_r1 = trpt->bup.oval;
		;
		goto R999;

	case 113: // STATE 204
		;
		now.loom_r0 = trpt->bup.oval;
		;
		goto R999;

	case 114: // STATE 205
		;
		now.loom_r0 = trpt->bup.oval;
		;
		goto R999;
;
		;
		;
		;
		;
		;
		
	case 118: // STATE 210
		;
		now.loom_r2 = trpt->bup.oval;
		;
		goto R999;

	case 119: // STATE 215
		;
		now.loom_r1 = trpt->bup.oval;
		;
		goto R999;

	case 120: // STATE 220
		;
		now.loom_r0 = trpt->bup.oval;
		;
		goto R999;

	case 121: // STATE 221
		;
		now.loom_r0 = trpt->bup.oval;
		;
		goto R999;
;
		;
		;
		;
		;
		;
		
	case 125: // STATE 226
		;
		now.loom_r2 = trpt->bup.oval;
		;
		goto R999;

	case 126: // STATE 231
		;
		now.loom_r1 = trpt->bup.oval;
		;
		goto R999;

	case 127: // STATE 236
		;
		now.loom_r0 = trpt->bup.oval;
		;
		goto R999;

	case 128: // STATE 237
		;
		now.loom_r0 = trpt->bup.oval;
		;
		goto R999;
;
		;
		;
		;
		;
		;
		
	case 132: // STATE 242
		;
		now.loom_r2 = trpt->bup.oval;
		;
		goto R999;

	case 133: // STATE 247
		;
		now.loom_r1 = trpt->bup.oval;
		;
		goto R999;

	case 134: // STATE 252
		;
		now.loom_r0 = trpt->bup.oval;
		;
		goto R999;

	case 135: // STATE 253
		;
		now.loom_r0 = trpt->bup.oval;
		;
		goto R999;
;
		;
		;
		;
		;
		;
		
	case 139: // STATE 258
		;
		now.loom_r2 = trpt->bup.oval;
		;
		goto R999;

	case 140: // STATE 263
		;
		now.loom_r1 = trpt->bup.oval;
		;
		goto R999;

	case 141: // STATE 268
		;
		now.loom_r0 = trpt->bup.oval;
		;
		goto R999;

	case 142: // STATE 269
		;
		now.loom_r0 = trpt->bup.oval;
		;
		goto R999;

	case 143: // STATE 271
		;
		XX = 1;
		unrecv(now.loom_events, XX-1, 0, 0, 1);
		;
		;
		goto R999;

	case 144: // STATE 272
		;
		((P0 *)_this)->taken = trpt->bup.oval;
		;
		goto R999;

	case 145: // STATE 273
		;
	/* 0 */	((P0 *)_this)->taken = trpt->bup.oval;
		;
		;
		goto R999;

	case 146: // STATE 274
		;
		((P0 *)_this)->taken = trpt->bup.ovals[0];
		;
		ungrab_ints(trpt->bup.ovals, 2);
		goto R999;
;
		;
		
	case 148: // STATE 276
		;
		now.loom_r2 = trpt->bup.oval;
		;
		goto R999;

	case 149: // STATE 281
		;
		now.loom_r1 = trpt->bup.oval;
		;
		goto R999;

	case 150: // STATE 282
		;
		now.loom_r1 = trpt->bup.oval;
		;
		goto R999;

	case 151: // STATE 283
		;
		now.loom_r2 = trpt->bup.oval;
		;
		goto R999;

	case 152: // STATE 284
		;
	/* 0 */	((P0 *)_this)->taken = trpt->bup.oval;
		;
		;
		goto R999;

	case 153: // STATE 286
		;
	/* 0 */	((P0 *)_this)->taken = trpt->bup.oval;
		;
		;
		goto R999;

	case 154: // STATE 291
		;
		((P0 *)_this)->taken = trpt->bup.oval;
		;
		goto R999;

	case 155: // STATE 292
		;
		XX = 1;
		unrecv(now.loom_events, XX-1, 0, 1, 1);
		;
		;
		goto R999;

	case 156: // STATE 293
		;
		((P0 *)_this)->taken = trpt->bup.oval;
		;
		goto R999;

	case 157: // STATE 294
		;
	/* 0 */	((P0 *)_this)->taken = trpt->bup.oval;
		;
		;
		goto R999;

	case 158: // STATE 295
		;
		((P0 *)_this)->taken = trpt->bup.ovals[0];
		;
		ungrab_ints(trpt->bup.ovals, 2);
		goto R999;
;
		;
		
	case 160: // STATE 297
		;
		now.loom_r2 = trpt->bup.oval;
		;
		goto R999;

	case 161: // STATE 302
		;
		now.loom_r1 = trpt->bup.oval;
		;
		goto R999;

	case 162: // STATE 303
		;
		now.loom_r1 = trpt->bup.oval;
		;
		goto R999;

	case 163: // STATE 304
		;
	/* 0 */	((P0 *)_this)->taken = trpt->bup.oval;
		;
		;
		goto R999;

	case 164: // STATE 309
		;
		((P0 *)_this)->taken = trpt->bup.oval;
		;
		goto R999;

	case 165: // STATE 310
		;
		XX = 1;
		unrecv(now.loom_events, XX-1, 0, 2, 1);
		;
		;
		goto R999;

	case 166: // STATE 311
		;
		((P0 *)_this)->taken = trpt->bup.oval;
		;
		goto R999;

	case 167: // STATE 312
		;
	/* 0 */	((P0 *)_this)->taken = trpt->bup.oval;
		;
		;
		goto R999;

	case 168: // STATE 313
		;
		((P0 *)_this)->taken = trpt->bup.ovals[0];
		;
		ungrab_ints(trpt->bup.ovals, 2);
		goto R999;
;
		;
		
	case 170: // STATE 315
		;
		now.loom_r2 = trpt->bup.oval;
		;
		goto R999;

	case 171: // STATE 320
		;
		now.loom_r1 = trpt->bup.oval;
		;
		goto R999;

	case 172: // STATE 321
		;
		now.loom_r1 = trpt->bup.oval;
		;
		goto R999;

	case 173: // STATE 322
		;
	/* 0 */	((P0 *)_this)->taken = trpt->bup.oval;
		;
		;
		goto R999;

	case 174: // STATE 327
		;
		((P0 *)_this)->taken = trpt->bup.oval;
		;
		goto R999;

	case 175: // STATE 328
		;
		XX = 1;
		unrecv(now.loom_events, XX-1, 0, 3, 1);
		;
		;
		goto R999;

	case 176: // STATE 329
		;
		((P0 *)_this)->taken = trpt->bup.oval;
		;
		goto R999;

	case 177: // STATE 330
		;
	/* 0 */	((P0 *)_this)->taken = trpt->bup.oval;
		;
		;
		goto R999;

	case 178: // STATE 331
		;
		((P0 *)_this)->taken = trpt->bup.ovals[0];
		;
		ungrab_ints(trpt->bup.ovals, 2);
		goto R999;
;
		;
		
	case 180: // STATE 333
		;
		now.loom_r2 = trpt->bup.oval;
		;
		goto R999;

	case 181: // STATE 338
		;
		now.loom_r1 = trpt->bup.oval;
		;
		goto R999;

	case 182: // STATE 339
		;
		now.loom_r1 = trpt->bup.oval;
		;
		goto R999;

	case 183: // STATE 340
		;
	/* 0 */	((P0 *)_this)->taken = trpt->bup.oval;
		;
		;
		goto R999;

	case 184: // STATE 345
		;
		((P0 *)_this)->taken = trpt->bup.oval;
		;
		goto R999;

	case 185: // STATE 346
		;
		XX = 1;
		unrecv(now.loom_events, XX-1, 0, 4, 1);
		;
		;
		goto R999;

	case 186: // STATE 347
		;
		((P0 *)_this)->taken = trpt->bup.oval;
		;
		goto R999;

	case 187: // STATE 348
		;
	/* 0 */	((P0 *)_this)->taken = trpt->bup.oval;
		;
		;
		goto R999;

	case 188: // STATE 349
		;
		((P0 *)_this)->taken = trpt->bup.oval;
		;
		goto R999;
;
		;
		
	case 190: // STATE 351
		;
		now.loom_r2 = trpt->bup.oval;
		;
		goto R999;

	case 191: // STATE 356
		;
		now.loom_r1 = trpt->bup.oval;
		;
		goto R999;

	case 192: // STATE 357
		;
		now.loom_r1 = trpt->bup.oval;
		;
		goto R999;
;
		;
		
	case 194: // STATE 362
		;
	/* 0 */	((P0 *)_this)->taken = trpt->bup.oval;
		;
		;
		goto R999;

	case 195: // STATE 363
		;
		((P0 *)_this)->taken = trpt->bup.oval;
		;
		goto R999;
;
		;
		
	case 197: // STATE 365
		;
		now.loom_r2 = trpt->bup.oval;
		;
		goto R999;

	case 198: // STATE 370
		;
		now.loom_r1 = trpt->bup.oval;
		;
		goto R999;

	case 199: // STATE 371
		;
		now.loom_r1 = trpt->bup.oval;
		;
		goto R999;
;
		;
		;
		;
		
	case 202: // STATE 378
		;
	/* 0 */	((P0 *)_this)->taken = trpt->bup.oval;
		;
		;
		goto R999;

	case 203: // STATE 379
		;
		((P0 *)_this)->taken = trpt->bup.ovals[0];
		;
		ungrab_ints(trpt->bup.ovals, 2);
		goto R999;
;
		;
		
	case 205: // STATE 381
		;
		now.loom_r2 = trpt->bup.oval;
		;
		goto R999;

	case 206: // STATE 386
		;
		now.loom_r1 = trpt->bup.oval;
		;
		goto R999;

	case 207: // STATE 387
		;
		now.loom_r1 = trpt->bup.oval;
		;
		goto R999;

	case 208: // STATE 388
		;
	/* 0 */	((P0 *)_this)->taken = trpt->bup.oval;
		;
		;
		goto R999;

	case 209: // STATE 393
		;
		((P0 *)_this)->taken = trpt->bup.oval;
		;
		goto R999;

	case 210: // STATE 394
		;
		XX = 1;
		unrecv(now.loom_events, XX-1, 0, 5, 1);
		;
		;
		goto R999;

	case 211: // STATE 395
		;
		((P0 *)_this)->taken = trpt->bup.oval;
		;
		goto R999;

	case 212: // STATE 396
		;
	/* 0 */	((P0 *)_this)->taken = trpt->bup.oval;
		;
		;
		goto R999;

	case 213: // STATE 397
		;
		((P0 *)_this)->taken = trpt->bup.oval;
		;
		goto R999;
;
		;
		
	case 215: // STATE 399
		;
		now.loom_r2 = trpt->bup.oval;
		;
		goto R999;

	case 216: // STATE 404
		;
		now.loom_r1 = trpt->bup.oval;
		;
		goto R999;

	case 217: // STATE 405
		;
		now.loom_r1 = trpt->bup.oval;
		;
		goto R999;
;
		;
		;
		;
		
	case 220: // STATE 412
		;
	/* 0 */	((P0 *)_this)->taken = trpt->bup.oval;
		;
		;
		goto R999;

	case 221: // STATE 413
		;
		((P0 *)_this)->taken = trpt->bup.oval;
		;
		goto R999;
;
		;
		;
		;
		
	case 224: // STATE 416
		;
		now.loom_r2 = trpt->bup.oval;
		;
		goto R999;

	case 225: // STATE 421
		;
		now.loom_r1 = trpt->bup.oval;
		;
		goto R999;

	case 226: // STATE 426
		;
		now.loom_r0 = trpt->bup.oval;
		;
		goto R999;

	case 227: // STATE 427
		;
		now.loom_r0 = trpt->bup.oval;
		;
		goto R999;

	case 228: // STATE 428
		;
		now.loom_r1 = trpt->bup.oval;
		;
		goto R999;
;
		;
		;
		;
		
	case 231: // STATE 435
		;
	/* 0 */	((P0 *)_this)->taken = trpt->bup.oval;
		;
		;
		goto R999;

	case 232: // STATE 436
		;
		((P0 *)_this)->taken = trpt->bup.ovals[0];
		;
		ungrab_ints(trpt->bup.ovals, 2);
		goto R999;
;
		;
		;
		;
		
	case 235: // STATE 439
		;
		now.loom_r2 = trpt->bup.oval;
		;
		goto R999;

	case 236: // STATE 444
		;
		now.loom_r1 = trpt->bup.oval;
		;
		goto R999;

	case 237: // STATE 449
		;
		now.loom_r0 = trpt->bup.oval;
		;
		goto R999;

	case 238: // STATE 450
		;
		now.loom_r0 = trpt->bup.oval;
		;
		goto R999;

	case 239: // STATE 451
		;
		now.loom_r1 = trpt->bup.oval;
		;
		goto R999;

	case 240: // STATE 452
		;
	/* 0 */	((P0 *)_this)->taken = trpt->bup.oval;
		;
		;
		goto R999;

	case 241: // STATE 454
		;
	/* 0 */	((P0 *)_this)->taken = trpt->bup.oval;
		;
		;
		goto R999;

	case 242: // STATE 459
		;
		((P0 *)_this)->taken = trpt->bup.oval;
		;
		goto R999;

	case 243: // STATE 460
		;
		XX = 1;
		unrecv(now.loom_events, XX-1, 0, 6, 1);
		;
		;
		goto R999;

	case 244: // STATE 461
		;
		((P0 *)_this)->taken = trpt->bup.oval;
		;
		goto R999;

	case 245: // STATE 462
		;
	/* 0 */	((P0 *)_this)->taken = trpt->bup.oval;
		;
		;
		goto R999;

	case 246: // STATE 463
		;
		((P0 *)_this)->taken = trpt->bup.ovals[0];
		;
		ungrab_ints(trpt->bup.ovals, 2);
		goto R999;
;
		;
		;
		;
		
	case 249: // STATE 466
		;
		now.loom_r2 = trpt->bup.oval;
		;
		goto R999;

	case 250: // STATE 471
		;
		now.loom_r1 = trpt->bup.oval;
		;
		goto R999;

	case 251: // STATE 476
		;
		now.loom_r0 = trpt->bup.oval;
		;
		goto R999;

	case 252: // STATE 477
		;
		now.loom_r0 = trpt->bup.oval;
		;
		goto R999;

	case 253: // STATE 478
		;
	/* 0 */	((P0 *)_this)->taken = trpt->bup.oval;
		;
		;
		goto R999;

	case 254: // STATE 483
		;
		((P0 *)_this)->taken = trpt->bup.oval;
		;
		goto R999;

	case 255: // STATE 484
		;
		XX = 1;
		unrecv(now.loom_events, XX-1, 0, 7, 1);
		;
		;
		goto R999;

	case 256: // STATE 485
		;
		((P0 *)_this)->taken = trpt->bup.oval;
		;
		goto R999;

	case 257: // STATE 486
		;
	/* 0 */	((P0 *)_this)->taken = trpt->bup.oval;
		;
		;
		goto R999;

	case 258: // STATE 487
		;
		((P0 *)_this)->taken = trpt->bup.ovals[0];
		;
		ungrab_ints(trpt->bup.ovals, 2);
		goto R999;
;
		;
		;
		;
		
	case 261: // STATE 490
		;
		now.loom_r2 = trpt->bup.oval;
		;
		goto R999;

	case 262: // STATE 495
		;
		now.loom_r1 = trpt->bup.oval;
		;
		goto R999;

	case 263: // STATE 500
		;
		now.loom_r0 = trpt->bup.oval;
		;
		goto R999;

	case 264: // STATE 501
		;
		now.loom_r0 = trpt->bup.oval;
		;
		goto R999;

	case 265: // STATE 502
		;
	/* 0 */	((P0 *)_this)->taken = trpt->bup.oval;
		;
		;
		goto R999;

	case 266: // STATE 507
		;
		((P0 *)_this)->taken = trpt->bup.oval;
		;
		goto R999;
;
		;
		;
		;
		;
		;
		;
		;
		;
		;
		;
		;
		
	case 273: // STATE 520
		;
		now.loom_r2 = trpt->bup.oval;
		;
		goto R999;

	case 274: // STATE 525
		;
		now.loom_r1 = trpt->bup.oval;
		;
		goto R999;

	case 275: // STATE 530
		;
		now.loom_r0 = trpt->bup.oval;
		;
		goto R999;

	case 276: // STATE 531
		;
		now.loom_wants_final = trpt->bup.oval;
		;
		goto R999;

	case 277: // STATE 532
		;
		loom_error = trpt->bup.oval;
		;
		goto R999;

	case 278: // STATE 533
		;
		((P0 *)_this)->at = trpt->bup.oval;
		;
		goto R999;

	case 279: // STATE 534
		;
		now.loom_r0 = trpt->bup.oval;
		;
		goto R999;
;
		;
		
	case 281: // STATE 537
		;
		now.loom_wants_final = trpt->bup.oval;
		;
		goto R999;
;
		;
		
	case 283: // STATE 539
		;
		now.loom_wants_initial = trpt->bup.oval;
		;
		goto R999;
;
		;
		;
		;
		;
		;
		
	case 287: // STATE 543
		;
		now.loom_r2 = trpt->bup.oval;
		;
		goto R999;

	case 288: // STATE 548
		;
		now.loom_r1 = trpt->bup.oval;
		;
		goto R999;

	case 289: // STATE 553
		;
		now.loom_r0 = trpt->bup.oval;
		;
		goto R999;

	case 290: // STATE 554
		;
		now.loom_wants_initial = trpt->bup.oval;
		;
		goto R999;

	case 291: // STATE 555
		;
		((P0 *)_this)->at = trpt->bup.oval;
		;
		goto R999;

	case 292: // STATE 556
		;
		now.loom_r0 = trpt->bup.oval;
		;
		goto R999;

	case 293: // STATE 557
		;
		now.loom_r1 = trpt->bup.oval;
		;
		goto R999;

	case 294: // STATE 562
		;
		loom_error = trpt->bup.oval;
		;
		goto R999;

	case 295: // STATE 563
		;
		((P0 *)_this)->at = trpt->bup.oval;
		;
		goto R999;

	case 296: // STATE 564
		;
		XX = 1;
		unrecv(now.loom_events, XX-1, 0, trpt->bup.oval, 1);
		;
		;
		goto R999;
;
		;
		
	case 298: // STATE 566
		;
		now.loom_wants_initial = trpt->bup.oval;
		;
		goto R999;
;
		;
		
	case 300: // STATE 573
		;
		p_restor(II);
		;
		;
		goto R999;
	}

