#define rand	pan_rand
#define pthread_equal(a,b)	((a)==(b))
#if defined(HAS_CODE) && defined(VERBOSE)
	#ifdef BFS_PAR
		bfs_printf("Pr: %d Tr: %d\n", II, t->forw);
	#else
		cpu_printf("Pr: %d Tr: %d\n", II, t->forw);
	#endif
#endif
	switch (t->forw) {
	default: Uerror("bad forward move");
	case 0:	/* if without executable clauses */
		continue;
	case 1: /* generic 'goto' or 'skip' */
		IfNotBlocked
		_m = 3; goto P999;
	case 2: /* generic 'else' */
		IfNotBlocked
		if (trpt->o_pm&1) continue;
		_m = 3; goto P999;

		 /* PROC scheduler */
	case 3: // STATE 1 - /tmp/pt/out/carpet_loom.loom.pml:614 - [(!(loom_go))] (0:0:0 - 0)
		IfNotBlocked
		reached[2][1] = 1;
		if (!( !(((int)now.loom_go))))
			continue;
		_m = 3; goto P999; /* 0 */
	case 4: // STATE 2 - /tmp/pt/out/carpet_loom.loom.pml:614 - [loom_go = 1] (0:0:1 - 0)
		IfNotBlocked
		reached[2][2] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_go);
		now.loom_go = 1;
#ifdef VAR_RANGES
		logval("loom_go", ((int)now.loom_go));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 5: // STATE 6 - /tmp/pt/out/carpet_loom.loom.pml:616 - [-end-] (0:0:0 - 0)
		IfNotBlocked
		reached[2][6] = 1;
		if (!delproc(1, II)) continue;
		_m = 3; goto P999; /* 0 */

		 /* PROC activity_world */
	case 6: // STATE 1 - /tmp/pt/out/carpet_loom.loom.pml:532 - [(((!(quiet)&&(len(loom_events)<=(8/2)))&&(((loom_r1==7)||(loom_r0==8))||(loom_r0==9))))] (0:0:0 - 0)
		IfNotBlocked
		reached[1][1] = 1;
		if (!((( !(((int)now.quiet))&&(q_len(now.loom_events)<=(8/2)))&&(((((int)now.loom_r1)==7)||(((int)now.loom_r0)==8))||(((int)now.loom_r0)==9)))))
			continue;
		_m = 3; goto P999; /* 0 */
	case 7: // STATE 2 - /tmp/pt/out/carpet_loom.loom.pml:534 - [(loom_started)] (0:0:0 - 0)
		IfNotBlocked
		reached[1][2] = 1;
		if (!(((int)now.loom_started)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 8: // STATE 3 - /tmp/pt/out/carpet_loom.loom.pml:534 - [assert(nfull(loom_events))] (0:0:0 - 0)
		IfNotBlocked
		reached[1][3] = 1;
		spin_assert((!q_full(now.loom_events)), "(!q_full(loom_events))", II, tt, t);
		_m = 3; goto P999; /* 0 */
	case 9: // STATE 4 - /tmp/pt/out/carpet_loom.loom.pml:534 - [loom_events!5] (0:0:0 - 0)
		IfNotBlocked
		reached[1][4] = 1;
		if (q_full(now.loom_events))
			continue;
#ifdef HAS_CODE
		if (readtrail && gui) {
			char simtmp[64];
			sprintf(simvals, "%d!", now.loom_events);
		sprintf(simtmp, "%d", 5); strcat(simvals, simtmp);		}
#endif
		
		qsend(now.loom_events, 0, 5, 1);
		_m = 2; goto P999; /* 0 */
	case 10: // STATE 11 - /tmp/pt/out/carpet_loom.loom.pml:539 - [(((!(quiet)&&(len(loom_events)<=(8/2)))&&(loom_r1==2)))] (0:0:0 - 0)
		IfNotBlocked
		reached[1][11] = 1;
		if (!((( !(((int)now.quiet))&&(q_len(now.loom_events)<=(8/2)))&&(((int)now.loom_r1)==2))))
			continue;
		_m = 3; goto P999; /* 0 */
	case 11: // STATE 12 - /tmp/pt/out/carpet_loom.loom.pml:541 - [(loom_started)] (0:0:0 - 0)
		IfNotBlocked
		reached[1][12] = 1;
		if (!(((int)now.loom_started)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 12: // STATE 13 - /tmp/pt/out/carpet_loom.loom.pml:541 - [assert(nfull(loom_events))] (0:0:0 - 0)
		IfNotBlocked
		reached[1][13] = 1;
		spin_assert((!q_full(now.loom_events)), "(!q_full(loom_events))", II, tt, t);
		_m = 3; goto P999; /* 0 */
	case 13: // STATE 14 - /tmp/pt/out/carpet_loom.loom.pml:541 - [loom_events!0] (0:0:0 - 0)
		IfNotBlocked
		reached[1][14] = 1;
		if (q_full(now.loom_events))
			continue;
#ifdef HAS_CODE
		if (readtrail && gui) {
			char simtmp[64];
			sprintf(simvals, "%d!", now.loom_events);
		sprintf(simtmp, "%d", 0); strcat(simvals, simtmp);		}
#endif
		
		qsend(now.loom_events, 0, 0, 1);
		_m = 2; goto P999; /* 0 */
	case 14: // STATE 21 - /tmp/pt/out/carpet_loom.loom.pml:546 - [(((!(quiet)&&(len(loom_events)<=(8/2)))&&(loom_r1==3)))] (0:0:0 - 0)
		IfNotBlocked
		reached[1][21] = 1;
		if (!((( !(((int)now.quiet))&&(q_len(now.loom_events)<=(8/2)))&&(((int)now.loom_r1)==3))))
			continue;
		_m = 3; goto P999; /* 0 */
	case 15: // STATE 22 - /tmp/pt/out/carpet_loom.loom.pml:548 - [(loom_started)] (0:0:0 - 0)
		IfNotBlocked
		reached[1][22] = 1;
		if (!(((int)now.loom_started)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 16: // STATE 23 - /tmp/pt/out/carpet_loom.loom.pml:548 - [assert(nfull(loom_events))] (0:0:0 - 0)
		IfNotBlocked
		reached[1][23] = 1;
		spin_assert((!q_full(now.loom_events)), "(!q_full(loom_events))", II, tt, t);
		_m = 3; goto P999; /* 0 */
	case 17: // STATE 24 - /tmp/pt/out/carpet_loom.loom.pml:548 - [loom_events!3] (0:0:0 - 0)
		IfNotBlocked
		reached[1][24] = 1;
		if (q_full(now.loom_events))
			continue;
#ifdef HAS_CODE
		if (readtrail && gui) {
			char simtmp[64];
			sprintf(simvals, "%d!", now.loom_events);
		sprintf(simtmp, "%d", 3); strcat(simvals, simtmp);		}
#endif
		
		qsend(now.loom_events, 0, 3, 1);
		_m = 2; goto P999; /* 0 */
	case 18: // STATE 31 - /tmp/pt/out/carpet_loom.loom.pml:553 - [(((!(quiet)&&(len(loom_events)<=(8/2)))&&(loom_r1==3)))] (0:0:0 - 0)
		IfNotBlocked
		reached[1][31] = 1;
		if (!((( !(((int)now.quiet))&&(q_len(now.loom_events)<=(8/2)))&&(((int)now.loom_r1)==3))))
			continue;
		_m = 3; goto P999; /* 0 */
	case 19: // STATE 32 - /tmp/pt/out/carpet_loom.loom.pml:555 - [(loom_started)] (0:0:0 - 0)
		IfNotBlocked
		reached[1][32] = 1;
		if (!(((int)now.loom_started)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 20: // STATE 33 - /tmp/pt/out/carpet_loom.loom.pml:555 - [assert(nfull(loom_events))] (0:0:0 - 0)
		IfNotBlocked
		reached[1][33] = 1;
		spin_assert((!q_full(now.loom_events)), "(!q_full(loom_events))", II, tt, t);
		_m = 3; goto P999; /* 0 */
	case 21: // STATE 34 - /tmp/pt/out/carpet_loom.loom.pml:555 - [loom_events!2] (0:0:0 - 0)
		IfNotBlocked
		reached[1][34] = 1;
		if (q_full(now.loom_events))
			continue;
#ifdef HAS_CODE
		if (readtrail && gui) {
			char simtmp[64];
			sprintf(simvals, "%d!", now.loom_events);
		sprintf(simtmp, "%d", 2); strcat(simvals, simtmp);		}
#endif
		
		qsend(now.loom_events, 0, 2, 1);
		_m = 2; goto P999; /* 0 */
	case 22: // STATE 41 - /tmp/pt/out/carpet_loom.loom.pml:560 - [(((!(quiet)&&(len(loom_events)<=(8/2)))&&(loom_r0==0)))] (0:0:0 - 0)
		IfNotBlocked
		reached[1][41] = 1;
		if (!((( !(((int)now.quiet))&&(q_len(now.loom_events)<=(8/2)))&&(((int)now.loom_r0)==0))))
			continue;
		_m = 3; goto P999; /* 0 */
	case 23: // STATE 42 - /tmp/pt/out/carpet_loom.loom.pml:562 - [(loom_started)] (0:0:0 - 0)
		IfNotBlocked
		reached[1][42] = 1;
		if (!(((int)now.loom_started)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 24: // STATE 43 - /tmp/pt/out/carpet_loom.loom.pml:562 - [assert(nfull(loom_events))] (0:0:0 - 0)
		IfNotBlocked
		reached[1][43] = 1;
		spin_assert((!q_full(now.loom_events)), "(!q_full(loom_events))", II, tt, t);
		_m = 3; goto P999; /* 0 */
	case 25: // STATE 44 - /tmp/pt/out/carpet_loom.loom.pml:562 - [loom_events!6] (0:0:0 - 0)
		IfNotBlocked
		reached[1][44] = 1;
		if (q_full(now.loom_events))
			continue;
#ifdef HAS_CODE
		if (readtrail && gui) {
			char simtmp[64];
			sprintf(simvals, "%d!", now.loom_events);
		sprintf(simtmp, "%d", 6); strcat(simvals, simtmp);		}
#endif
		
		qsend(now.loom_events, 0, 6, 1);
		_m = 2; goto P999; /* 0 */
	case 26: // STATE 51 - /tmp/pt/out/carpet_loom.loom.pml:567 - [(((!(quiet)&&(len(loom_events)<=(8/2)))&&(loom_r0==0)))] (0:0:0 - 0)
		IfNotBlocked
		reached[1][51] = 1;
		if (!((( !(((int)now.quiet))&&(q_len(now.loom_events)<=(8/2)))&&(((int)now.loom_r0)==0))))
			continue;
		_m = 3; goto P999; /* 0 */
	case 27: // STATE 52 - /tmp/pt/out/carpet_loom.loom.pml:569 - [(loom_started)] (0:0:0 - 0)
		IfNotBlocked
		reached[1][52] = 1;
		if (!(((int)now.loom_started)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 28: // STATE 53 - /tmp/pt/out/carpet_loom.loom.pml:569 - [assert(nfull(loom_events))] (0:0:0 - 0)
		IfNotBlocked
		reached[1][53] = 1;
		spin_assert((!q_full(now.loom_events)), "(!q_full(loom_events))", II, tt, t);
		_m = 3; goto P999; /* 0 */
	case 29: // STATE 54 - /tmp/pt/out/carpet_loom.loom.pml:569 - [loom_events!7] (0:0:0 - 0)
		IfNotBlocked
		reached[1][54] = 1;
		if (q_full(now.loom_events))
			continue;
#ifdef HAS_CODE
		if (readtrail && gui) {
			char simtmp[64];
			sprintf(simvals, "%d!", now.loom_events);
		sprintf(simtmp, "%d", 7); strcat(simvals, simtmp);		}
#endif
		
		qsend(now.loom_events, 0, 7, 1);
		_m = 2; goto P999; /* 0 */
	case 30: // STATE 61 - /tmp/pt/out/carpet_loom.loom.pml:574 - [(((!(quiet)&&(len(loom_events)<=(8/2)))&&(((loom_r1==3)||(loom_r1==6))||(loom_r1==6))))] (0:0:0 - 0)
		IfNotBlocked
		reached[1][61] = 1;
		if (!((( !(((int)now.quiet))&&(q_len(now.loom_events)<=(8/2)))&&(((((int)now.loom_r1)==3)||(((int)now.loom_r1)==6))||(((int)now.loom_r1)==6)))))
			continue;
		_m = 3; goto P999; /* 0 */
	case 31: // STATE 62 - /tmp/pt/out/carpet_loom.loom.pml:576 - [(loom_started)] (0:0:0 - 0)
		IfNotBlocked
		reached[1][62] = 1;
		if (!(((int)now.loom_started)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 32: // STATE 63 - /tmp/pt/out/carpet_loom.loom.pml:576 - [assert(nfull(loom_events))] (0:0:0 - 0)
		IfNotBlocked
		reached[1][63] = 1;
		spin_assert((!q_full(now.loom_events)), "(!q_full(loom_events))", II, tt, t);
		_m = 3; goto P999; /* 0 */
	case 33: // STATE 64 - /tmp/pt/out/carpet_loom.loom.pml:576 - [loom_events!4] (0:0:0 - 0)
		IfNotBlocked
		reached[1][64] = 1;
		if (q_full(now.loom_events))
			continue;
#ifdef HAS_CODE
		if (readtrail && gui) {
			char simtmp[64];
			sprintf(simvals, "%d!", now.loom_events);
		sprintf(simtmp, "%d", 4); strcat(simvals, simtmp);		}
#endif
		
		qsend(now.loom_events, 0, 4, 1);
		_m = 2; goto P999; /* 0 */
	case 34: // STATE 71 - /tmp/pt/out/carpet_loom.loom.pml:581 - [(((!(quiet)&&(len(loom_events)<=(8/2)))&&(loom_r1==3)))] (0:0:0 - 0)
		IfNotBlocked
		reached[1][71] = 1;
		if (!((( !(((int)now.quiet))&&(q_len(now.loom_events)<=(8/2)))&&(((int)now.loom_r1)==3))))
			continue;
		_m = 3; goto P999; /* 0 */
	case 35: // STATE 72 - /tmp/pt/out/carpet_loom.loom.pml:583 - [(loom_started)] (0:0:0 - 0)
		IfNotBlocked
		reached[1][72] = 1;
		if (!(((int)now.loom_started)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 36: // STATE 73 - /tmp/pt/out/carpet_loom.loom.pml:583 - [assert(nfull(loom_events))] (0:0:0 - 0)
		IfNotBlocked
		reached[1][73] = 1;
		spin_assert((!q_full(now.loom_events)), "(!q_full(loom_events))", II, tt, t);
		_m = 3; goto P999; /* 0 */
	case 37: // STATE 74 - /tmp/pt/out/carpet_loom.loom.pml:583 - [loom_events!1] (0:0:0 - 0)
		IfNotBlocked
		reached[1][74] = 1;
		if (q_full(now.loom_events))
			continue;
#ifdef HAS_CODE
		if (readtrail && gui) {
			char simtmp[64];
			sprintf(simvals, "%d!", now.loom_events);
		sprintf(simtmp, "%d", 1); strcat(simvals, simtmp);		}
#endif
		
		qsend(now.loom_events, 0, 1, 1);
		_m = 2; goto P999; /* 0 */
	case 38: // STATE 84 - /tmp/pt/out/carpet_loom.loom.pml:589 - [-end-] (0:0:0 - 0)
		IfNotBlocked
		reached[1][84] = 1;
		if (!delproc(1, II)) continue;
		_m = 3; goto P999; /* 0 */

		 /* PROC machine_loom */
	case 39: // STATE 1 - /tmp/pt/out/carpet_loom.loom.pml:34 - [loom_r0 = 0] (0:0:1 - 0)
		IfNotBlocked
		reached[0][1] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r0);
		now.loom_r0 = 0;
#ifdef VAR_RANGES
		logval("loom_r0", ((int)now.loom_r0));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 40: // STATE 2 - /tmp/pt/out/carpet_loom.loom.pml:35 - [loom_r1 = 1] (0:0:1 - 0)
		IfNotBlocked
		reached[0][2] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r1);
		now.loom_r1 = 1;
#ifdef VAR_RANGES
		logval("loom_r1", ((int)now.loom_r1));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 41: // STATE 3 - /tmp/pt/out/carpet_loom.loom.pml:36 - [loom_started = 1] (0:0:1 - 0)
		IfNotBlocked
		reached[0][3] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_started);
		now.loom_started = 1;
#ifdef VAR_RANGES
		logval("loom_started", ((int)now.loom_started));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 42: // STATE 5 - /tmp/pt/out/carpet_loom.loom.pml:40 - [((loom_r0==0))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][5] = 1;
		if (!((((int)now.loom_r0)==0)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 43: // STATE 11 - /tmp/pt/out/carpet_loom.loom.pml:44 - [((loom_r1==1))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][11] = 1;
		if (!((((int)now.loom_r1)==1)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 44: // STATE 17 - /tmp/pt/out/carpet_loom.loom.pml:48 - [((loom_r1==2))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][17] = 1;
		if (!((((int)now.loom_r1)==2)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 45: // STATE 23 - /tmp/pt/out/carpet_loom.loom.pml:52 - [((loom_r1==3))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][23] = 1;
		if (!((((int)now.loom_r1)==3)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 46: // STATE 29 - /tmp/pt/out/carpet_loom.loom.pml:56 - [((loom_r2==4))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][29] = 1;
		if (!((((int)now.loom_r2)==4)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 47: // STATE 35 - /tmp/pt/out/carpet_loom.loom.pml:60 - [((loom_r2==5))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][35] = 1;
		if (!((((int)now.loom_r2)==5)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 48: // STATE 41 - /tmp/pt/out/carpet_loom.loom.pml:64 - [((loom_r1==6))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][41] = 1;
		if (!((((int)now.loom_r1)==6)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 49: // STATE 47 - /tmp/pt/out/carpet_loom.loom.pml:68 - [((loom_r1==7))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][47] = 1;
		if (!((((int)now.loom_r1)==7)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 50: // STATE 53 - /tmp/pt/out/carpet_loom.loom.pml:72 - [((loom_r0==8))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][53] = 1;
		if (!((((int)now.loom_r0)==8)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 51: // STATE 59 - /tmp/pt/out/carpet_loom.loom.pml:76 - [((loom_r0==9))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][59] = 1;
		if (!((((int)now.loom_r0)==9)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 52: // STATE 65 - /tmp/pt/out/carpet_loom.loom.pml:80 - [((loom_r0==10))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][65] = 1;
		if (!((((int)now.loom_r0)==10)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 53: // STATE 71 - /tmp/pt/out/carpet_loom.loom.pml:85 - [((loom_r1==1))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][71] = 1;
		if (!((((int)now.loom_r1)==1)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 54: // STATE 72 - /tmp/pt/out/carpet_loom.loom.pml:87 - [((loom_r1==3))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][72] = 1;
		if (!((((int)now.loom_r1)==3)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 55: // STATE 73 - /tmp/pt/out/carpet_loom.loom.pml:88 - [loom_r2 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][73] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r2);
		now.loom_r2 = 255;
#ifdef VAR_RANGES
		logval("loom_r2", ((int)now.loom_r2));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 56: // STATE 78 - /tmp/pt/out/carpet_loom.loom.pml:91 - [loom_r1 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][78] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r1);
		now.loom_r1 = 255;
#ifdef VAR_RANGES
		logval("loom_r1", ((int)now.loom_r1));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 57: // STATE 79 - /tmp/pt/out/carpet_loom.loom.pml:92 - [loom_r1 = 2] (0:0:1 - 0)
		IfNotBlocked
		reached[0][79] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r1);
		now.loom_r1 = 2;
#ifdef VAR_RANGES
		logval("loom_r1", ((int)now.loom_r1));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 58: // STATE 81 - /tmp/pt/out/carpet_loom.loom.pml:94 - [((loom_r1==2))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][81] = 1;
		if (!((((int)now.loom_r1)==2)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 59: // STATE 82 - /tmp/pt/out/carpet_loom.loom.pml:96 - [((loom_r1==3))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][82] = 1;
		if (!((((int)now.loom_r1)==3)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 60: // STATE 83 - /tmp/pt/out/carpet_loom.loom.pml:97 - [loom_r2 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][83] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r2);
		now.loom_r2 = 255;
#ifdef VAR_RANGES
		logval("loom_r2", ((int)now.loom_r2));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 61: // STATE 88 - /tmp/pt/out/carpet_loom.loom.pml:100 - [loom_r1 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][88] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r1);
		now.loom_r1 = 255;
#ifdef VAR_RANGES
		logval("loom_r1", ((int)now.loom_r1));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 62: // STATE 89 - /tmp/pt/out/carpet_loom.loom.pml:101 - [loom_r1 = 1] (0:0:1 - 0)
		IfNotBlocked
		reached[0][89] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r1);
		now.loom_r1 = 1;
#ifdef VAR_RANGES
		logval("loom_r1", ((int)now.loom_r1));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 63: // STATE 91 - /tmp/pt/out/carpet_loom.loom.pml:103 - [((loom_r2==4))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][91] = 1;
		if (!((((int)now.loom_r2)==4)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 64: // STATE 92 - /tmp/pt/out/carpet_loom.loom.pml:104 - [loom_r2 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][92] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r2);
		now.loom_r2 = 255;
#ifdef VAR_RANGES
		logval("loom_r2", ((int)now.loom_r2));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 65: // STATE 93 - /tmp/pt/out/carpet_loom.loom.pml:105 - [loom_r2 = 5] (0:0:1 - 0)
		IfNotBlocked
		reached[0][93] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r2);
		now.loom_r2 = 5;
#ifdef VAR_RANGES
		logval("loom_r2", ((int)now.loom_r2));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 66: // STATE 95 - /tmp/pt/out/carpet_loom.loom.pml:107 - [((loom_r2==4))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][95] = 1;
		if (!((((int)now.loom_r2)==4)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 67: // STATE 96 - /tmp/pt/out/carpet_loom.loom.pml:109 - [((loom_r0==0))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][96] = 1;
		if (!((((int)now.loom_r0)==0)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 68: // STATE 97 - /tmp/pt/out/carpet_loom.loom.pml:111 - [((loom_r1==3))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][97] = 1;
		if (!((((int)now.loom_r1)==3)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 69: // STATE 98 - /tmp/pt/out/carpet_loom.loom.pml:112 - [loom_r2 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][98] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r2);
		now.loom_r2 = 255;
#ifdef VAR_RANGES
		logval("loom_r2", ((int)now.loom_r2));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 70: // STATE 103 - /tmp/pt/out/carpet_loom.loom.pml:115 - [loom_r1 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][103] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r1);
		now.loom_r1 = 255;
#ifdef VAR_RANGES
		logval("loom_r1", ((int)now.loom_r1));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 71: // STATE 108 - /tmp/pt/out/carpet_loom.loom.pml:118 - [loom_r0 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][108] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r0);
		now.loom_r0 = 255;
#ifdef VAR_RANGES
		logval("loom_r0", ((int)now.loom_r0));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 72: // STATE 109 - /tmp/pt/out/carpet_loom.loom.pml:119 - [loom_r0 = 9] (0:0:1 - 0)
		IfNotBlocked
		reached[0][109] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r0);
		now.loom_r0 = 9;
#ifdef VAR_RANGES
		logval("loom_r0", ((int)now.loom_r0));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 73: // STATE 111 - /tmp/pt/out/carpet_loom.loom.pml:121 - [((loom_r1==3))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][111] = 1;
		if (!((((int)now.loom_r1)==3)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 74: // STATE 112 - /tmp/pt/out/carpet_loom.loom.pml:123 - [((loom_r0==0))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][112] = 1;
		if (!((((int)now.loom_r0)==0)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 75: // STATE 113 - /tmp/pt/out/carpet_loom.loom.pml:125 - [((loom_r1==3))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][113] = 1;
		if (!((((int)now.loom_r1)==3)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 76: // STATE 114 - /tmp/pt/out/carpet_loom.loom.pml:126 - [loom_r2 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][114] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r2);
		now.loom_r2 = 255;
#ifdef VAR_RANGES
		logval("loom_r2", ((int)now.loom_r2));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 77: // STATE 119 - /tmp/pt/out/carpet_loom.loom.pml:129 - [loom_r1 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][119] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r1);
		now.loom_r1 = 255;
#ifdef VAR_RANGES
		logval("loom_r1", ((int)now.loom_r1));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 78: // STATE 124 - /tmp/pt/out/carpet_loom.loom.pml:132 - [loom_r0 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][124] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r0);
		now.loom_r0 = 255;
#ifdef VAR_RANGES
		logval("loom_r0", ((int)now.loom_r0));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 79: // STATE 125 - /tmp/pt/out/carpet_loom.loom.pml:133 - [loom_r0 = 9] (0:0:1 - 0)
		IfNotBlocked
		reached[0][125] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r0);
		now.loom_r0 = 9;
#ifdef VAR_RANGES
		logval("loom_r0", ((int)now.loom_r0));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 80: // STATE 127 - /tmp/pt/out/carpet_loom.loom.pml:135 - [((loom_r1==3))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][127] = 1;
		if (!((((int)now.loom_r1)==3)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 81: // STATE 128 - /tmp/pt/out/carpet_loom.loom.pml:137 - [((loom_r0==0))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][128] = 1;
		if (!((((int)now.loom_r0)==0)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 82: // STATE 129 - /tmp/pt/out/carpet_loom.loom.pml:139 - [((loom_r1==3))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][129] = 1;
		if (!((((int)now.loom_r1)==3)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 83: // STATE 130 - /tmp/pt/out/carpet_loom.loom.pml:140 - [loom_r2 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][130] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r2);
		now.loom_r2 = 255;
#ifdef VAR_RANGES
		logval("loom_r2", ((int)now.loom_r2));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 84: // STATE 135 - /tmp/pt/out/carpet_loom.loom.pml:143 - [loom_r1 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][135] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r1);
		now.loom_r1 = 255;
#ifdef VAR_RANGES
		logval("loom_r1", ((int)now.loom_r1));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 85: // STATE 140 - /tmp/pt/out/carpet_loom.loom.pml:146 - [loom_r0 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][140] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r0);
		now.loom_r0 = 255;
#ifdef VAR_RANGES
		logval("loom_r0", ((int)now.loom_r0));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 86: // STATE 141 - /tmp/pt/out/carpet_loom.loom.pml:147 - [loom_r0 = 9] (0:0:1 - 0)
		IfNotBlocked
		reached[0][141] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r0);
		now.loom_r0 = 9;
#ifdef VAR_RANGES
		logval("loom_r0", ((int)now.loom_r0));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 87: // STATE 143 - /tmp/pt/out/carpet_loom.loom.pml:149 - [((loom_r1==3))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][143] = 1;
		if (!((((int)now.loom_r1)==3)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 88: // STATE 144 - /tmp/pt/out/carpet_loom.loom.pml:151 - [((loom_r0==0))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][144] = 1;
		if (!((((int)now.loom_r0)==0)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 89: // STATE 145 - /tmp/pt/out/carpet_loom.loom.pml:153 - [((loom_r1==3))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][145] = 1;
		if (!((((int)now.loom_r1)==3)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 90: // STATE 146 - /tmp/pt/out/carpet_loom.loom.pml:154 - [loom_r2 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][146] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r2);
		now.loom_r2 = 255;
#ifdef VAR_RANGES
		logval("loom_r2", ((int)now.loom_r2));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 91: // STATE 151 - /tmp/pt/out/carpet_loom.loom.pml:157 - [loom_r1 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][151] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r1);
		now.loom_r1 = 255;
#ifdef VAR_RANGES
		logval("loom_r1", ((int)now.loom_r1));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 92: // STATE 156 - /tmp/pt/out/carpet_loom.loom.pml:160 - [loom_r0 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][156] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r0);
		now.loom_r0 = 255;
#ifdef VAR_RANGES
		logval("loom_r0", ((int)now.loom_r0));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 93: // STATE 157 - /tmp/pt/out/carpet_loom.loom.pml:161 - [loom_r0 = 9] (0:0:1 - 0)
		IfNotBlocked
		reached[0][157] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r0);
		now.loom_r0 = 9;
#ifdef VAR_RANGES
		logval("loom_r0", ((int)now.loom_r0));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 94: // STATE 159 - /tmp/pt/out/carpet_loom.loom.pml:163 - [((loom_r2==5))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][159] = 1;
		if (!((((int)now.loom_r2)==5)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 95: // STATE 160 - /tmp/pt/out/carpet_loom.loom.pml:165 - [((loom_r0==0))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][160] = 1;
		if (!((((int)now.loom_r0)==0)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 96: // STATE 161 - /tmp/pt/out/carpet_loom.loom.pml:167 - [((loom_r1==3))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][161] = 1;
		if (!((((int)now.loom_r1)==3)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 97: // STATE 162 - /tmp/pt/out/carpet_loom.loom.pml:168 - [loom_r2 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][162] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r2);
		now.loom_r2 = 255;
#ifdef VAR_RANGES
		logval("loom_r2", ((int)now.loom_r2));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 98: // STATE 167 - /tmp/pt/out/carpet_loom.loom.pml:171 - [loom_r1 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][167] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r1);
		now.loom_r1 = 255;
#ifdef VAR_RANGES
		logval("loom_r1", ((int)now.loom_r1));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 99: // STATE 172 - /tmp/pt/out/carpet_loom.loom.pml:174 - [loom_r0 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][172] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r0);
		now.loom_r0 = 255;
#ifdef VAR_RANGES
		logval("loom_r0", ((int)now.loom_r0));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 100: // STATE 173 - /tmp/pt/out/carpet_loom.loom.pml:175 - [loom_r0 = 9] (0:0:1 - 0)
		IfNotBlocked
		reached[0][173] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r0);
		now.loom_r0 = 9;
#ifdef VAR_RANGES
		logval("loom_r0", ((int)now.loom_r0));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 101: // STATE 175 - /tmp/pt/out/carpet_loom.loom.pml:177 - [((loom_r1==6))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][175] = 1;
		if (!((((int)now.loom_r1)==6)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 102: // STATE 176 - /tmp/pt/out/carpet_loom.loom.pml:179 - [((loom_r0==0))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][176] = 1;
		if (!((((int)now.loom_r0)==0)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 103: // STATE 177 - /tmp/pt/out/carpet_loom.loom.pml:181 - [((loom_r1==3))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][177] = 1;
		if (!((((int)now.loom_r1)==3)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 104: // STATE 178 - /tmp/pt/out/carpet_loom.loom.pml:182 - [loom_r2 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][178] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r2);
		now.loom_r2 = 255;
#ifdef VAR_RANGES
		logval("loom_r2", ((int)now.loom_r2));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 105: // STATE 183 - /tmp/pt/out/carpet_loom.loom.pml:185 - [loom_r1 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][183] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r1);
		now.loom_r1 = 255;
#ifdef VAR_RANGES
		logval("loom_r1", ((int)now.loom_r1));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 106: // STATE 188 - /tmp/pt/out/carpet_loom.loom.pml:188 - [loom_r0 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][188] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r0);
		now.loom_r0 = 255;
#ifdef VAR_RANGES
		logval("loom_r0", ((int)now.loom_r0));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 107: // STATE 189 - /tmp/pt/out/carpet_loom.loom.pml:189 - [loom_r0 = 9] (0:0:1 - 0)
		IfNotBlocked
		reached[0][189] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r0);
		now.loom_r0 = 9;
#ifdef VAR_RANGES
		logval("loom_r0", ((int)now.loom_r0));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 108: // STATE 191 - /tmp/pt/out/carpet_loom.loom.pml:191 - [((loom_r1==6))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][191] = 1;
		if (!((((int)now.loom_r1)==6)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 109: // STATE 192 - /tmp/pt/out/carpet_loom.loom.pml:193 - [((loom_r0==0))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][192] = 1;
		if (!((((int)now.loom_r0)==0)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 110: // STATE 193 - /tmp/pt/out/carpet_loom.loom.pml:195 - [((loom_r1==3))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][193] = 1;
		if (!((((int)now.loom_r1)==3)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 111: // STATE 194 - /tmp/pt/out/carpet_loom.loom.pml:196 - [loom_r2 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][194] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r2);
		now.loom_r2 = 255;
#ifdef VAR_RANGES
		logval("loom_r2", ((int)now.loom_r2));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 112: // STATE 199 - /tmp/pt/out/carpet_loom.loom.pml:199 - [loom_r1 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][199] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r1);
		now.loom_r1 = 255;
#ifdef VAR_RANGES
		logval("loom_r1", ((int)now.loom_r1));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 113: // STATE 204 - /tmp/pt/out/carpet_loom.loom.pml:202 - [loom_r0 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][204] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r0);
		now.loom_r0 = 255;
#ifdef VAR_RANGES
		logval("loom_r0", ((int)now.loom_r0));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 114: // STATE 205 - /tmp/pt/out/carpet_loom.loom.pml:203 - [loom_r0 = 9] (0:0:1 - 0)
		IfNotBlocked
		reached[0][205] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r0);
		now.loom_r0 = 9;
#ifdef VAR_RANGES
		logval("loom_r0", ((int)now.loom_r0));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 115: // STATE 207 - /tmp/pt/out/carpet_loom.loom.pml:205 - [((loom_r1==6))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][207] = 1;
		if (!((((int)now.loom_r1)==6)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 116: // STATE 208 - /tmp/pt/out/carpet_loom.loom.pml:207 - [((loom_r0==0))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][208] = 1;
		if (!((((int)now.loom_r0)==0)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 117: // STATE 209 - /tmp/pt/out/carpet_loom.loom.pml:209 - [((loom_r1==3))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][209] = 1;
		if (!((((int)now.loom_r1)==3)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 118: // STATE 210 - /tmp/pt/out/carpet_loom.loom.pml:210 - [loom_r2 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][210] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r2);
		now.loom_r2 = 255;
#ifdef VAR_RANGES
		logval("loom_r2", ((int)now.loom_r2));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 119: // STATE 215 - /tmp/pt/out/carpet_loom.loom.pml:213 - [loom_r1 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][215] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r1);
		now.loom_r1 = 255;
#ifdef VAR_RANGES
		logval("loom_r1", ((int)now.loom_r1));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 120: // STATE 220 - /tmp/pt/out/carpet_loom.loom.pml:216 - [loom_r0 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][220] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r0);
		now.loom_r0 = 255;
#ifdef VAR_RANGES
		logval("loom_r0", ((int)now.loom_r0));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 121: // STATE 221 - /tmp/pt/out/carpet_loom.loom.pml:217 - [loom_r0 = 9] (0:0:1 - 0)
		IfNotBlocked
		reached[0][221] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r0);
		now.loom_r0 = 9;
#ifdef VAR_RANGES
		logval("loom_r0", ((int)now.loom_r0));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 122: // STATE 223 - /tmp/pt/out/carpet_loom.loom.pml:219 - [((loom_r0==0))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][223] = 1;
		if (!((((int)now.loom_r0)==0)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 123: // STATE 224 - /tmp/pt/out/carpet_loom.loom.pml:221 - [((loom_r0==0))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][224] = 1;
		if (!((((int)now.loom_r0)==0)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 124: // STATE 225 - /tmp/pt/out/carpet_loom.loom.pml:223 - [((loom_r1==3))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][225] = 1;
		if (!((((int)now.loom_r1)==3)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 125: // STATE 226 - /tmp/pt/out/carpet_loom.loom.pml:224 - [loom_r2 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][226] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r2);
		now.loom_r2 = 255;
#ifdef VAR_RANGES
		logval("loom_r2", ((int)now.loom_r2));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 126: // STATE 231 - /tmp/pt/out/carpet_loom.loom.pml:227 - [loom_r1 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][231] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r1);
		now.loom_r1 = 255;
#ifdef VAR_RANGES
		logval("loom_r1", ((int)now.loom_r1));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 127: // STATE 236 - /tmp/pt/out/carpet_loom.loom.pml:230 - [loom_r0 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][236] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r0);
		now.loom_r0 = 255;
#ifdef VAR_RANGES
		logval("loom_r0", ((int)now.loom_r0));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 128: // STATE 237 - /tmp/pt/out/carpet_loom.loom.pml:231 - [loom_r0 = 8] (0:0:1 - 0)
		IfNotBlocked
		reached[0][237] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r0);
		now.loom_r0 = 8;
#ifdef VAR_RANGES
		logval("loom_r0", ((int)now.loom_r0));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 129: // STATE 239 - /tmp/pt/out/carpet_loom.loom.pml:233 - [((loom_r0==0))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][239] = 1;
		if (!((((int)now.loom_r0)==0)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 130: // STATE 240 - /tmp/pt/out/carpet_loom.loom.pml:235 - [((loom_r0==0))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][240] = 1;
		if (!((((int)now.loom_r0)==0)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 131: // STATE 241 - /tmp/pt/out/carpet_loom.loom.pml:237 - [((loom_r1==3))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][241] = 1;
		if (!((((int)now.loom_r1)==3)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 132: // STATE 242 - /tmp/pt/out/carpet_loom.loom.pml:238 - [loom_r2 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][242] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r2);
		now.loom_r2 = 255;
#ifdef VAR_RANGES
		logval("loom_r2", ((int)now.loom_r2));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 133: // STATE 247 - /tmp/pt/out/carpet_loom.loom.pml:241 - [loom_r1 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][247] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r1);
		now.loom_r1 = 255;
#ifdef VAR_RANGES
		logval("loom_r1", ((int)now.loom_r1));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 134: // STATE 252 - /tmp/pt/out/carpet_loom.loom.pml:244 - [loom_r0 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][252] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r0);
		now.loom_r0 = 255;
#ifdef VAR_RANGES
		logval("loom_r0", ((int)now.loom_r0));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 135: // STATE 253 - /tmp/pt/out/carpet_loom.loom.pml:245 - [loom_r0 = 9] (0:0:1 - 0)
		IfNotBlocked
		reached[0][253] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r0);
		now.loom_r0 = 9;
#ifdef VAR_RANGES
		logval("loom_r0", ((int)now.loom_r0));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 136: // STATE 255 - /tmp/pt/out/carpet_loom.loom.pml:247 - [((loom_r1==3))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][255] = 1;
		if (!((((int)now.loom_r1)==3)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 137: // STATE 256 - /tmp/pt/out/carpet_loom.loom.pml:249 - [((loom_r0==0))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][256] = 1;
		if (!((((int)now.loom_r0)==0)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 138: // STATE 257 - /tmp/pt/out/carpet_loom.loom.pml:251 - [((loom_r1==3))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][257] = 1;
		if (!((((int)now.loom_r1)==3)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 139: // STATE 258 - /tmp/pt/out/carpet_loom.loom.pml:252 - [loom_r2 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][258] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r2);
		now.loom_r2 = 255;
#ifdef VAR_RANGES
		logval("loom_r2", ((int)now.loom_r2));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 140: // STATE 263 - /tmp/pt/out/carpet_loom.loom.pml:255 - [loom_r1 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][263] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r1);
		now.loom_r1 = 255;
#ifdef VAR_RANGES
		logval("loom_r1", ((int)now.loom_r1));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 141: // STATE 268 - /tmp/pt/out/carpet_loom.loom.pml:258 - [loom_r0 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][268] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r0);
		now.loom_r0 = 255;
#ifdef VAR_RANGES
		logval("loom_r0", ((int)now.loom_r0));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 142: // STATE 269 - /tmp/pt/out/carpet_loom.loom.pml:259 - [loom_r0 = 9] (0:0:1 - 0)
		IfNotBlocked
		reached[0][269] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r0);
		now.loom_r0 = 9;
#ifdef VAR_RANGES
		logval("loom_r0", ((int)now.loom_r0));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 143: // STATE 271 - /tmp/pt/out/carpet_loom.loom.pml:261 - [loom_events?0] (0:0:0 - 0)
		reached[0][271] = 1;
		if (q_len(now.loom_events) == 0) continue;

		XX=1;
		if (0 != qrecv(now.loom_events, 0, 0, 0)) continue;
		
#ifndef BFS_PAR
		if (q_flds[((Q0 *)qptr(now.loom_events-1))->_t] != 1)
			Uerror("wrong nr of msg fields in rcv");
#endif
		;
		qrecv(now.loom_events, XX-1, 0, 1);
		
#ifdef HAS_CODE
		if (readtrail && gui) {
			char simtmp[32];
			sprintf(simvals, "%d?", now.loom_events);
		sprintf(simtmp, "%d", 0); strcat(simvals, simtmp);		}
#endif
		;
		_m = 4; goto P999; /* 0 */
	case 144: // STATE 272 - /tmp/pt/out/carpet_loom.loom.pml:262 - [taken = 0] (0:0:1 - 0)
		IfNotBlocked
		reached[0][272] = 1;
		(trpt+1)->bup.oval = ((int)((P0 *)_this)->taken);
		((P0 *)_this)->taken = 0;
#ifdef VAR_RANGES
		logval("machine_loom:taken", ((int)((P0 *)_this)->taken));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 145: // STATE 273 - /tmp/pt/out/carpet_loom.loom.pml:264 - [(((loom_r1==2)&&!(taken)))] (0:0:1 - 0)
		IfNotBlocked
		reached[0][273] = 1;
		if (!(((((int)now.loom_r1)==2)&& !(((int)((P0 *)_this)->taken)))))
			continue;
		if (TstOnly) return 1; /* TT */
		/* dead 1: taken */  (trpt+1)->bup.oval = ((P0 *)_this)->taken;
#ifdef HAS_CODE
		if (!readtrail)
#endif
			((P0 *)_this)->taken = 0;
		_m = 3; goto P999; /* 0 */
	case 146: // STATE 274 - /tmp/pt/out/carpet_loom.loom.pml:265 - [taken = 1] (0:0:2 - 0)
		IfNotBlocked
		reached[0][274] = 1;
		(trpt+1)->bup.ovals = grab_ints(2);
		(trpt+1)->bup.ovals[0] = ((int)((P0 *)_this)->taken);
		((P0 *)_this)->taken = 1;
#ifdef VAR_RANGES
		logval("machine_loom:taken", ((int)((P0 *)_this)->taken));
#endif
		;
		if (TstOnly) return 1; /* TT */
		/* dead 2: taken */  
#ifdef HAS_CODE
		if (!readtrail)
#endif
			((P0 *)_this)->taken = 0;
		_m = 3; goto P999; /* 0 */
	case 147: // STATE 275 - /tmp/pt/out/carpet_loom.loom.pml:267 - [((loom_r1==3))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][275] = 1;
		if (!((((int)now.loom_r1)==3)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 148: // STATE 276 - /tmp/pt/out/carpet_loom.loom.pml:268 - [loom_r2 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][276] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r2);
		now.loom_r2 = 255;
#ifdef VAR_RANGES
		logval("loom_r2", ((int)now.loom_r2));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 149: // STATE 281 - /tmp/pt/out/carpet_loom.loom.pml:271 - [loom_r1 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][281] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r1);
		now.loom_r1 = 255;
#ifdef VAR_RANGES
		logval("loom_r1", ((int)now.loom_r1));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 150: // STATE 282 - /tmp/pt/out/carpet_loom.loom.pml:272 - [loom_r1 = 3] (0:0:1 - 0)
		IfNotBlocked
		reached[0][282] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r1);
		now.loom_r1 = 3;
#ifdef VAR_RANGES
		logval("loom_r1", ((int)now.loom_r1));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 151: // STATE 283 - /tmp/pt/out/carpet_loom.loom.pml:273 - [loom_r2 = 4] (0:0:1 - 0)
		IfNotBlocked
		reached[0][283] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r2);
		now.loom_r2 = 4;
#ifdef VAR_RANGES
		logval("loom_r2", ((int)now.loom_r2));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 152: // STATE 284 - /tmp/pt/out/carpet_loom.loom.pml:274 - [(((loom_r1==2)&&!(taken)))] (0:0:1 - 0)
		IfNotBlocked
		reached[0][284] = 1;
		if (!(((((int)now.loom_r1)==2)&& !(((int)((P0 *)_this)->taken)))))
			continue;
		if (TstOnly) return 1; /* TT */
		/* dead 1: taken */  (trpt+1)->bup.oval = ((P0 *)_this)->taken;
#ifdef HAS_CODE
		if (!readtrail)
#endif
			((P0 *)_this)->taken = 0;
		_m = 3; goto P999; /* 0 */
	case 153: // STATE 286 - /tmp/pt/out/carpet_loom.loom.pml:276 - [(!(((loom_r1==2)&&!(taken))))] (0:0:1 - 0)
		IfNotBlocked
		reached[0][286] = 1;
		if (!( !(((((int)now.loom_r1)==2)&& !(((int)((P0 *)_this)->taken))))))
			continue;
		if (TstOnly) return 1; /* TT */
		/* dead 1: taken */  (trpt+1)->bup.oval = ((P0 *)_this)->taken;
#ifdef HAS_CODE
		if (!readtrail)
#endif
			((P0 *)_this)->taken = 0;
		_m = 3; goto P999; /* 0 */
	case 154: // STATE 291 - /tmp/pt/out/carpet_loom.loom.pml:279 - [taken = 0] (0:0:1 - 0)
		IfNotBlocked
		reached[0][291] = 1;
		(trpt+1)->bup.oval = ((int)((P0 *)_this)->taken);
		((P0 *)_this)->taken = 0;
#ifdef VAR_RANGES
		logval("machine_loom:taken", ((int)((P0 *)_this)->taken));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 155: // STATE 292 - /tmp/pt/out/carpet_loom.loom.pml:280 - [loom_events?1] (0:0:0 - 0)
		reached[0][292] = 1;
		if (q_len(now.loom_events) == 0) continue;

		XX=1;
		if (1 != qrecv(now.loom_events, 0, 0, 0)) continue;
		
#ifndef BFS_PAR
		if (q_flds[((Q0 *)qptr(now.loom_events-1))->_t] != 1)
			Uerror("wrong nr of msg fields in rcv");
#endif
		;
		qrecv(now.loom_events, XX-1, 0, 1);
		
#ifdef HAS_CODE
		if (readtrail && gui) {
			char simtmp[32];
			sprintf(simvals, "%d?", now.loom_events);
		sprintf(simtmp, "%d", 1); strcat(simvals, simtmp);		}
#endif
		;
		_m = 4; goto P999; /* 0 */
	case 156: // STATE 293 - /tmp/pt/out/carpet_loom.loom.pml:281 - [taken = 0] (0:0:1 - 0)
		IfNotBlocked
		reached[0][293] = 1;
		(trpt+1)->bup.oval = ((int)((P0 *)_this)->taken);
		((P0 *)_this)->taken = 0;
#ifdef VAR_RANGES
		logval("machine_loom:taken", ((int)((P0 *)_this)->taken));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 157: // STATE 294 - /tmp/pt/out/carpet_loom.loom.pml:283 - [(((loom_r1==3)&&!(taken)))] (0:0:1 - 0)
		IfNotBlocked
		reached[0][294] = 1;
		if (!(((((int)now.loom_r1)==3)&& !(((int)((P0 *)_this)->taken)))))
			continue;
		if (TstOnly) return 1; /* TT */
		/* dead 1: taken */  (trpt+1)->bup.oval = ((P0 *)_this)->taken;
#ifdef HAS_CODE
		if (!readtrail)
#endif
			((P0 *)_this)->taken = 0;
		_m = 3; goto P999; /* 0 */
	case 158: // STATE 295 - /tmp/pt/out/carpet_loom.loom.pml:284 - [taken = 1] (0:0:2 - 0)
		IfNotBlocked
		reached[0][295] = 1;
		(trpt+1)->bup.ovals = grab_ints(2);
		(trpt+1)->bup.ovals[0] = ((int)((P0 *)_this)->taken);
		((P0 *)_this)->taken = 1;
#ifdef VAR_RANGES
		logval("machine_loom:taken", ((int)((P0 *)_this)->taken));
#endif
		;
		if (TstOnly) return 1; /* TT */
		/* dead 2: taken */  
#ifdef HAS_CODE
		if (!readtrail)
#endif
			((P0 *)_this)->taken = 0;
		_m = 3; goto P999; /* 0 */
	case 159: // STATE 296 - /tmp/pt/out/carpet_loom.loom.pml:286 - [((loom_r1==3))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][296] = 1;
		if (!((((int)now.loom_r1)==3)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 160: // STATE 297 - /tmp/pt/out/carpet_loom.loom.pml:287 - [loom_r2 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][297] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r2);
		now.loom_r2 = 255;
#ifdef VAR_RANGES
		logval("loom_r2", ((int)now.loom_r2));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 161: // STATE 302 - /tmp/pt/out/carpet_loom.loom.pml:290 - [loom_r1 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][302] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r1);
		now.loom_r1 = 255;
#ifdef VAR_RANGES
		logval("loom_r1", ((int)now.loom_r1));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 162: // STATE 303 - /tmp/pt/out/carpet_loom.loom.pml:291 - [loom_r1 = 6] (0:0:1 - 0)
		IfNotBlocked
		reached[0][303] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r1);
		now.loom_r1 = 6;
#ifdef VAR_RANGES
		logval("loom_r1", ((int)now.loom_r1));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 163: // STATE 304 - /tmp/pt/out/carpet_loom.loom.pml:292 - [(!(((loom_r1==3)&&!(taken))))] (0:0:1 - 0)
		IfNotBlocked
		reached[0][304] = 1;
		if (!( !(((((int)now.loom_r1)==3)&& !(((int)((P0 *)_this)->taken))))))
			continue;
		if (TstOnly) return 1; /* TT */
		/* dead 1: taken */  (trpt+1)->bup.oval = ((P0 *)_this)->taken;
#ifdef HAS_CODE
		if (!readtrail)
#endif
			((P0 *)_this)->taken = 0;
		_m = 3; goto P999; /* 0 */
	case 164: // STATE 309 - /tmp/pt/out/carpet_loom.loom.pml:295 - [taken = 0] (0:0:1 - 0)
		IfNotBlocked
		reached[0][309] = 1;
		(trpt+1)->bup.oval = ((int)((P0 *)_this)->taken);
		((P0 *)_this)->taken = 0;
#ifdef VAR_RANGES
		logval("machine_loom:taken", ((int)((P0 *)_this)->taken));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 165: // STATE 310 - /tmp/pt/out/carpet_loom.loom.pml:296 - [loom_events?2] (0:0:0 - 0)
		reached[0][310] = 1;
		if (q_len(now.loom_events) == 0) continue;

		XX=1;
		if (2 != qrecv(now.loom_events, 0, 0, 0)) continue;
		
#ifndef BFS_PAR
		if (q_flds[((Q0 *)qptr(now.loom_events-1))->_t] != 1)
			Uerror("wrong nr of msg fields in rcv");
#endif
		;
		qrecv(now.loom_events, XX-1, 0, 1);
		
#ifdef HAS_CODE
		if (readtrail && gui) {
			char simtmp[32];
			sprintf(simvals, "%d?", now.loom_events);
		sprintf(simtmp, "%d", 2); strcat(simvals, simtmp);		}
#endif
		;
		_m = 4; goto P999; /* 0 */
	case 166: // STATE 311 - /tmp/pt/out/carpet_loom.loom.pml:297 - [taken = 0] (0:0:1 - 0)
		IfNotBlocked
		reached[0][311] = 1;
		(trpt+1)->bup.oval = ((int)((P0 *)_this)->taken);
		((P0 *)_this)->taken = 0;
#ifdef VAR_RANGES
		logval("machine_loom:taken", ((int)((P0 *)_this)->taken));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 167: // STATE 312 - /tmp/pt/out/carpet_loom.loom.pml:299 - [(((loom_r1==3)&&!(taken)))] (0:0:1 - 0)
		IfNotBlocked
		reached[0][312] = 1;
		if (!(((((int)now.loom_r1)==3)&& !(((int)((P0 *)_this)->taken)))))
			continue;
		if (TstOnly) return 1; /* TT */
		/* dead 1: taken */  (trpt+1)->bup.oval = ((P0 *)_this)->taken;
#ifdef HAS_CODE
		if (!readtrail)
#endif
			((P0 *)_this)->taken = 0;
		_m = 3; goto P999; /* 0 */
	case 168: // STATE 313 - /tmp/pt/out/carpet_loom.loom.pml:300 - [taken = 1] (0:0:2 - 0)
		IfNotBlocked
		reached[0][313] = 1;
		(trpt+1)->bup.ovals = grab_ints(2);
		(trpt+1)->bup.ovals[0] = ((int)((P0 *)_this)->taken);
		((P0 *)_this)->taken = 1;
#ifdef VAR_RANGES
		logval("machine_loom:taken", ((int)((P0 *)_this)->taken));
#endif
		;
		if (TstOnly) return 1; /* TT */
		/* dead 2: taken */  
#ifdef HAS_CODE
		if (!readtrail)
#endif
			((P0 *)_this)->taken = 0;
		_m = 3; goto P999; /* 0 */
	case 169: // STATE 314 - /tmp/pt/out/carpet_loom.loom.pml:302 - [((loom_r1==3))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][314] = 1;
		if (!((((int)now.loom_r1)==3)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 170: // STATE 315 - /tmp/pt/out/carpet_loom.loom.pml:303 - [loom_r2 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][315] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r2);
		now.loom_r2 = 255;
#ifdef VAR_RANGES
		logval("loom_r2", ((int)now.loom_r2));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 171: // STATE 320 - /tmp/pt/out/carpet_loom.loom.pml:306 - [loom_r1 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][320] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r1);
		now.loom_r1 = 255;
#ifdef VAR_RANGES
		logval("loom_r1", ((int)now.loom_r1));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 172: // STATE 321 - /tmp/pt/out/carpet_loom.loom.pml:307 - [loom_r1 = 6] (0:0:1 - 0)
		IfNotBlocked
		reached[0][321] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r1);
		now.loom_r1 = 6;
#ifdef VAR_RANGES
		logval("loom_r1", ((int)now.loom_r1));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 173: // STATE 322 - /tmp/pt/out/carpet_loom.loom.pml:308 - [(!(((loom_r1==3)&&!(taken))))] (0:0:1 - 0)
		IfNotBlocked
		reached[0][322] = 1;
		if (!( !(((((int)now.loom_r1)==3)&& !(((int)((P0 *)_this)->taken))))))
			continue;
		if (TstOnly) return 1; /* TT */
		/* dead 1: taken */  (trpt+1)->bup.oval = ((P0 *)_this)->taken;
#ifdef HAS_CODE
		if (!readtrail)
#endif
			((P0 *)_this)->taken = 0;
		_m = 3; goto P999; /* 0 */
	case 174: // STATE 327 - /tmp/pt/out/carpet_loom.loom.pml:311 - [taken = 0] (0:0:1 - 0)
		IfNotBlocked
		reached[0][327] = 1;
		(trpt+1)->bup.oval = ((int)((P0 *)_this)->taken);
		((P0 *)_this)->taken = 0;
#ifdef VAR_RANGES
		logval("machine_loom:taken", ((int)((P0 *)_this)->taken));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 175: // STATE 328 - /tmp/pt/out/carpet_loom.loom.pml:312 - [loom_events?3] (0:0:0 - 0)
		reached[0][328] = 1;
		if (q_len(now.loom_events) == 0) continue;

		XX=1;
		if (3 != qrecv(now.loom_events, 0, 0, 0)) continue;
		
#ifndef BFS_PAR
		if (q_flds[((Q0 *)qptr(now.loom_events-1))->_t] != 1)
			Uerror("wrong nr of msg fields in rcv");
#endif
		;
		qrecv(now.loom_events, XX-1, 0, 1);
		
#ifdef HAS_CODE
		if (readtrail && gui) {
			char simtmp[32];
			sprintf(simvals, "%d?", now.loom_events);
		sprintf(simtmp, "%d", 3); strcat(simvals, simtmp);		}
#endif
		;
		_m = 4; goto P999; /* 0 */
	case 176: // STATE 329 - /tmp/pt/out/carpet_loom.loom.pml:313 - [taken = 0] (0:0:1 - 0)
		IfNotBlocked
		reached[0][329] = 1;
		(trpt+1)->bup.oval = ((int)((P0 *)_this)->taken);
		((P0 *)_this)->taken = 0;
#ifdef VAR_RANGES
		logval("machine_loom:taken", ((int)((P0 *)_this)->taken));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 177: // STATE 330 - /tmp/pt/out/carpet_loom.loom.pml:315 - [(((loom_r1==3)&&!(taken)))] (0:0:1 - 0)
		IfNotBlocked
		reached[0][330] = 1;
		if (!(((((int)now.loom_r1)==3)&& !(((int)((P0 *)_this)->taken)))))
			continue;
		if (TstOnly) return 1; /* TT */
		/* dead 1: taken */  (trpt+1)->bup.oval = ((P0 *)_this)->taken;
#ifdef HAS_CODE
		if (!readtrail)
#endif
			((P0 *)_this)->taken = 0;
		_m = 3; goto P999; /* 0 */
	case 178: // STATE 331 - /tmp/pt/out/carpet_loom.loom.pml:316 - [taken = 1] (0:0:2 - 0)
		IfNotBlocked
		reached[0][331] = 1;
		(trpt+1)->bup.ovals = grab_ints(2);
		(trpt+1)->bup.ovals[0] = ((int)((P0 *)_this)->taken);
		((P0 *)_this)->taken = 1;
#ifdef VAR_RANGES
		logval("machine_loom:taken", ((int)((P0 *)_this)->taken));
#endif
		;
		if (TstOnly) return 1; /* TT */
		/* dead 2: taken */  
#ifdef HAS_CODE
		if (!readtrail)
#endif
			((P0 *)_this)->taken = 0;
		_m = 3; goto P999; /* 0 */
	case 179: // STATE 332 - /tmp/pt/out/carpet_loom.loom.pml:318 - [((loom_r1==3))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][332] = 1;
		if (!((((int)now.loom_r1)==3)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 180: // STATE 333 - /tmp/pt/out/carpet_loom.loom.pml:319 - [loom_r2 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][333] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r2);
		now.loom_r2 = 255;
#ifdef VAR_RANGES
		logval("loom_r2", ((int)now.loom_r2));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 181: // STATE 338 - /tmp/pt/out/carpet_loom.loom.pml:322 - [loom_r1 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][338] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r1);
		now.loom_r1 = 255;
#ifdef VAR_RANGES
		logval("loom_r1", ((int)now.loom_r1));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 182: // STATE 339 - /tmp/pt/out/carpet_loom.loom.pml:323 - [loom_r1 = 6] (0:0:1 - 0)
		IfNotBlocked
		reached[0][339] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r1);
		now.loom_r1 = 6;
#ifdef VAR_RANGES
		logval("loom_r1", ((int)now.loom_r1));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 183: // STATE 340 - /tmp/pt/out/carpet_loom.loom.pml:324 - [(!(((loom_r1==3)&&!(taken))))] (0:0:1 - 0)
		IfNotBlocked
		reached[0][340] = 1;
		if (!( !(((((int)now.loom_r1)==3)&& !(((int)((P0 *)_this)->taken))))))
			continue;
		if (TstOnly) return 1; /* TT */
		/* dead 1: taken */  (trpt+1)->bup.oval = ((P0 *)_this)->taken;
#ifdef HAS_CODE
		if (!readtrail)
#endif
			((P0 *)_this)->taken = 0;
		_m = 3; goto P999; /* 0 */
	case 184: // STATE 345 - /tmp/pt/out/carpet_loom.loom.pml:327 - [taken = 0] (0:0:1 - 0)
		IfNotBlocked
		reached[0][345] = 1;
		(trpt+1)->bup.oval = ((int)((P0 *)_this)->taken);
		((P0 *)_this)->taken = 0;
#ifdef VAR_RANGES
		logval("machine_loom:taken", ((int)((P0 *)_this)->taken));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 185: // STATE 346 - /tmp/pt/out/carpet_loom.loom.pml:328 - [loom_events?4] (0:0:0 - 0)
		reached[0][346] = 1;
		if (q_len(now.loom_events) == 0) continue;

		XX=1;
		if (4 != qrecv(now.loom_events, 0, 0, 0)) continue;
		
#ifndef BFS_PAR
		if (q_flds[((Q0 *)qptr(now.loom_events-1))->_t] != 1)
			Uerror("wrong nr of msg fields in rcv");
#endif
		;
		qrecv(now.loom_events, XX-1, 0, 1);
		
#ifdef HAS_CODE
		if (readtrail && gui) {
			char simtmp[32];
			sprintf(simvals, "%d?", now.loom_events);
		sprintf(simtmp, "%d", 4); strcat(simvals, simtmp);		}
#endif
		;
		_m = 4; goto P999; /* 0 */
	case 186: // STATE 347 - /tmp/pt/out/carpet_loom.loom.pml:329 - [taken = 0] (0:0:1 - 0)
		IfNotBlocked
		reached[0][347] = 1;
		(trpt+1)->bup.oval = ((int)((P0 *)_this)->taken);
		((P0 *)_this)->taken = 0;
#ifdef VAR_RANGES
		logval("machine_loom:taken", ((int)((P0 *)_this)->taken));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 187: // STATE 348 - /tmp/pt/out/carpet_loom.loom.pml:331 - [(((loom_r1==3)&&!(taken)))] (0:0:1 - 0)
		IfNotBlocked
		reached[0][348] = 1;
		if (!(((((int)now.loom_r1)==3)&& !(((int)((P0 *)_this)->taken)))))
			continue;
		if (TstOnly) return 1; /* TT */
		/* dead 1: taken */  (trpt+1)->bup.oval = ((P0 *)_this)->taken;
#ifdef HAS_CODE
		if (!readtrail)
#endif
			((P0 *)_this)->taken = 0;
		_m = 3; goto P999; /* 0 */
	case 188: // STATE 349 - /tmp/pt/out/carpet_loom.loom.pml:332 - [taken = 1] (0:0:1 - 0)
		IfNotBlocked
		reached[0][349] = 1;
		(trpt+1)->bup.oval = ((int)((P0 *)_this)->taken);
		((P0 *)_this)->taken = 1;
#ifdef VAR_RANGES
		logval("machine_loom:taken", ((int)((P0 *)_this)->taken));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 189: // STATE 350 - /tmp/pt/out/carpet_loom.loom.pml:334 - [((loom_r1==3))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][350] = 1;
		if (!((((int)now.loom_r1)==3)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 190: // STATE 351 - /tmp/pt/out/carpet_loom.loom.pml:335 - [loom_r2 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][351] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r2);
		now.loom_r2 = 255;
#ifdef VAR_RANGES
		logval("loom_r2", ((int)now.loom_r2));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 191: // STATE 356 - /tmp/pt/out/carpet_loom.loom.pml:338 - [loom_r1 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][356] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r1);
		now.loom_r1 = 255;
#ifdef VAR_RANGES
		logval("loom_r1", ((int)now.loom_r1));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 192: // STATE 357 - /tmp/pt/out/carpet_loom.loom.pml:339 - [loom_r1 = 2] (0:0:1 - 0)
		IfNotBlocked
		reached[0][357] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r1);
		now.loom_r1 = 2;
#ifdef VAR_RANGES
		logval("loom_r1", ((int)now.loom_r1));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 193: // STATE 358 - /tmp/pt/out/carpet_loom.loom.pml:340 - [(!(((loom_r1==3)&&!(taken))))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][358] = 1;
		if (!( !(((((int)now.loom_r1)==3)&& !(((int)((P0 *)_this)->taken))))))
			continue;
		_m = 3; goto P999; /* 0 */
	case 194: // STATE 362 - /tmp/pt/out/carpet_loom.loom.pml:343 - [(((loom_r1==6)&&!(taken)))] (0:0:1 - 0)
		IfNotBlocked
		reached[0][362] = 1;
		if (!(((((int)now.loom_r1)==6)&& !(((int)((P0 *)_this)->taken)))))
			continue;
		if (TstOnly) return 1; /* TT */
		/* dead 1: taken */  (trpt+1)->bup.oval = ((P0 *)_this)->taken;
#ifdef HAS_CODE
		if (!readtrail)
#endif
			((P0 *)_this)->taken = 0;
		_m = 3; goto P999; /* 0 */
	case 195: // STATE 363 - /tmp/pt/out/carpet_loom.loom.pml:344 - [taken = 1] (0:0:1 - 0)
		IfNotBlocked
		reached[0][363] = 1;
		(trpt+1)->bup.oval = ((int)((P0 *)_this)->taken);
		((P0 *)_this)->taken = 1;
#ifdef VAR_RANGES
		logval("machine_loom:taken", ((int)((P0 *)_this)->taken));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 196: // STATE 364 - /tmp/pt/out/carpet_loom.loom.pml:346 - [((loom_r1==3))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][364] = 1;
		if (!((((int)now.loom_r1)==3)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 197: // STATE 365 - /tmp/pt/out/carpet_loom.loom.pml:347 - [loom_r2 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][365] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r2);
		now.loom_r2 = 255;
#ifdef VAR_RANGES
		logval("loom_r2", ((int)now.loom_r2));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 198: // STATE 370 - /tmp/pt/out/carpet_loom.loom.pml:350 - [loom_r1 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][370] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r1);
		now.loom_r1 = 255;
#ifdef VAR_RANGES
		logval("loom_r1", ((int)now.loom_r1));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 199: // STATE 371 - /tmp/pt/out/carpet_loom.loom.pml:351 - [loom_r1 = 2] (0:0:1 - 0)
		IfNotBlocked
		reached[0][371] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r1);
		now.loom_r1 = 2;
#ifdef VAR_RANGES
		logval("loom_r1", ((int)now.loom_r1));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 200: // STATE 372 - /tmp/pt/out/carpet_loom.loom.pml:352 - [(((loom_r1==6)&&!(taken)))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][372] = 1;
		if (!(((((int)now.loom_r1)==6)&& !(((int)((P0 *)_this)->taken)))))
			continue;
		_m = 3; goto P999; /* 0 */
	case 201: // STATE 374 - /tmp/pt/out/carpet_loom.loom.pml:354 - [(!(((loom_r1==6)&&!(taken))))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][374] = 1;
		if (!( !(((((int)now.loom_r1)==6)&& !(((int)((P0 *)_this)->taken))))))
			continue;
		_m = 3; goto P999; /* 0 */
	case 202: // STATE 378 - /tmp/pt/out/carpet_loom.loom.pml:357 - [(((loom_r1==6)&&!(taken)))] (0:0:1 - 0)
		IfNotBlocked
		reached[0][378] = 1;
		if (!(((((int)now.loom_r1)==6)&& !(((int)((P0 *)_this)->taken)))))
			continue;
		if (TstOnly) return 1; /* TT */
		/* dead 1: taken */  (trpt+1)->bup.oval = ((P0 *)_this)->taken;
#ifdef HAS_CODE
		if (!readtrail)
#endif
			((P0 *)_this)->taken = 0;
		_m = 3; goto P999; /* 0 */
	case 203: // STATE 379 - /tmp/pt/out/carpet_loom.loom.pml:358 - [taken = 1] (0:0:2 - 0)
		IfNotBlocked
		reached[0][379] = 1;
		(trpt+1)->bup.ovals = grab_ints(2);
		(trpt+1)->bup.ovals[0] = ((int)((P0 *)_this)->taken);
		((P0 *)_this)->taken = 1;
#ifdef VAR_RANGES
		logval("machine_loom:taken", ((int)((P0 *)_this)->taken));
#endif
		;
		if (TstOnly) return 1; /* TT */
		/* dead 2: taken */  
#ifdef HAS_CODE
		if (!readtrail)
#endif
			((P0 *)_this)->taken = 0;
		_m = 3; goto P999; /* 0 */
	case 204: // STATE 380 - /tmp/pt/out/carpet_loom.loom.pml:360 - [((loom_r1==3))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][380] = 1;
		if (!((((int)now.loom_r1)==3)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 205: // STATE 381 - /tmp/pt/out/carpet_loom.loom.pml:361 - [loom_r2 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][381] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r2);
		now.loom_r2 = 255;
#ifdef VAR_RANGES
		logval("loom_r2", ((int)now.loom_r2));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 206: // STATE 386 - /tmp/pt/out/carpet_loom.loom.pml:364 - [loom_r1 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][386] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r1);
		now.loom_r1 = 255;
#ifdef VAR_RANGES
		logval("loom_r1", ((int)now.loom_r1));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 207: // STATE 387 - /tmp/pt/out/carpet_loom.loom.pml:365 - [loom_r1 = 7] (0:0:1 - 0)
		IfNotBlocked
		reached[0][387] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r1);
		now.loom_r1 = 7;
#ifdef VAR_RANGES
		logval("loom_r1", ((int)now.loom_r1));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 208: // STATE 388 - /tmp/pt/out/carpet_loom.loom.pml:366 - [(!(((loom_r1==6)&&!(taken))))] (0:0:1 - 0)
		IfNotBlocked
		reached[0][388] = 1;
		if (!( !(((((int)now.loom_r1)==6)&& !(((int)((P0 *)_this)->taken))))))
			continue;
		if (TstOnly) return 1; /* TT */
		/* dead 1: taken */  (trpt+1)->bup.oval = ((P0 *)_this)->taken;
#ifdef HAS_CODE
		if (!readtrail)
#endif
			((P0 *)_this)->taken = 0;
		_m = 3; goto P999; /* 0 */
	case 209: // STATE 393 - /tmp/pt/out/carpet_loom.loom.pml:369 - [taken = 0] (0:0:1 - 0)
		IfNotBlocked
		reached[0][393] = 1;
		(trpt+1)->bup.oval = ((int)((P0 *)_this)->taken);
		((P0 *)_this)->taken = 0;
#ifdef VAR_RANGES
		logval("machine_loom:taken", ((int)((P0 *)_this)->taken));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 210: // STATE 394 - /tmp/pt/out/carpet_loom.loom.pml:370 - [loom_events?5] (0:0:0 - 0)
		reached[0][394] = 1;
		if (q_len(now.loom_events) == 0) continue;

		XX=1;
		if (5 != qrecv(now.loom_events, 0, 0, 0)) continue;
		
#ifndef BFS_PAR
		if (q_flds[((Q0 *)qptr(now.loom_events-1))->_t] != 1)
			Uerror("wrong nr of msg fields in rcv");
#endif
		;
		qrecv(now.loom_events, XX-1, 0, 1);
		
#ifdef HAS_CODE
		if (readtrail && gui) {
			char simtmp[32];
			sprintf(simvals, "%d?", now.loom_events);
		sprintf(simtmp, "%d", 5); strcat(simvals, simtmp);		}
#endif
		;
		_m = 4; goto P999; /* 0 */
	case 211: // STATE 395 - /tmp/pt/out/carpet_loom.loom.pml:371 - [taken = 0] (0:0:1 - 0)
		IfNotBlocked
		reached[0][395] = 1;
		(trpt+1)->bup.oval = ((int)((P0 *)_this)->taken);
		((P0 *)_this)->taken = 0;
#ifdef VAR_RANGES
		logval("machine_loom:taken", ((int)((P0 *)_this)->taken));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 212: // STATE 396 - /tmp/pt/out/carpet_loom.loom.pml:373 - [(((loom_r1==7)&&!(taken)))] (0:0:1 - 0)
		IfNotBlocked
		reached[0][396] = 1;
		if (!(((((int)now.loom_r1)==7)&& !(((int)((P0 *)_this)->taken)))))
			continue;
		if (TstOnly) return 1; /* TT */
		/* dead 1: taken */  (trpt+1)->bup.oval = ((P0 *)_this)->taken;
#ifdef HAS_CODE
		if (!readtrail)
#endif
			((P0 *)_this)->taken = 0;
		_m = 3; goto P999; /* 0 */
	case 213: // STATE 397 - /tmp/pt/out/carpet_loom.loom.pml:374 - [taken = 1] (0:0:1 - 0)
		IfNotBlocked
		reached[0][397] = 1;
		(trpt+1)->bup.oval = ((int)((P0 *)_this)->taken);
		((P0 *)_this)->taken = 1;
#ifdef VAR_RANGES
		logval("machine_loom:taken", ((int)((P0 *)_this)->taken));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 214: // STATE 398 - /tmp/pt/out/carpet_loom.loom.pml:376 - [((loom_r1==3))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][398] = 1;
		if (!((((int)now.loom_r1)==3)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 215: // STATE 399 - /tmp/pt/out/carpet_loom.loom.pml:377 - [loom_r2 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][399] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r2);
		now.loom_r2 = 255;
#ifdef VAR_RANGES
		logval("loom_r2", ((int)now.loom_r2));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 216: // STATE 404 - /tmp/pt/out/carpet_loom.loom.pml:380 - [loom_r1 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][404] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r1);
		now.loom_r1 = 255;
#ifdef VAR_RANGES
		logval("loom_r1", ((int)now.loom_r1));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 217: // STATE 405 - /tmp/pt/out/carpet_loom.loom.pml:381 - [loom_r1 = 1] (0:0:1 - 0)
		IfNotBlocked
		reached[0][405] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r1);
		now.loom_r1 = 1;
#ifdef VAR_RANGES
		logval("loom_r1", ((int)now.loom_r1));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 218: // STATE 406 - /tmp/pt/out/carpet_loom.loom.pml:382 - [(((loom_r1==7)&&!(taken)))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][406] = 1;
		if (!(((((int)now.loom_r1)==7)&& !(((int)((P0 *)_this)->taken)))))
			continue;
		_m = 3; goto P999; /* 0 */
	case 219: // STATE 408 - /tmp/pt/out/carpet_loom.loom.pml:384 - [(!(((loom_r1==7)&&!(taken))))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][408] = 1;
		if (!( !(((((int)now.loom_r1)==7)&& !(((int)((P0 *)_this)->taken))))))
			continue;
		_m = 3; goto P999; /* 0 */
	case 220: // STATE 412 - /tmp/pt/out/carpet_loom.loom.pml:387 - [(((loom_r0==8)&&!(taken)))] (0:0:1 - 0)
		IfNotBlocked
		reached[0][412] = 1;
		if (!(((((int)now.loom_r0)==8)&& !(((int)((P0 *)_this)->taken)))))
			continue;
		if (TstOnly) return 1; /* TT */
		/* dead 1: taken */  (trpt+1)->bup.oval = ((P0 *)_this)->taken;
#ifdef HAS_CODE
		if (!readtrail)
#endif
			((P0 *)_this)->taken = 0;
		_m = 3; goto P999; /* 0 */
	case 221: // STATE 413 - /tmp/pt/out/carpet_loom.loom.pml:388 - [taken = 1] (0:0:1 - 0)
		IfNotBlocked
		reached[0][413] = 1;
		(trpt+1)->bup.oval = ((int)((P0 *)_this)->taken);
		((P0 *)_this)->taken = 1;
#ifdef VAR_RANGES
		logval("machine_loom:taken", ((int)((P0 *)_this)->taken));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 222: // STATE 414 - /tmp/pt/out/carpet_loom.loom.pml:390 - [((loom_r0==0))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][414] = 1;
		if (!((((int)now.loom_r0)==0)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 223: // STATE 415 - /tmp/pt/out/carpet_loom.loom.pml:392 - [((loom_r1==3))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][415] = 1;
		if (!((((int)now.loom_r1)==3)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 224: // STATE 416 - /tmp/pt/out/carpet_loom.loom.pml:393 - [loom_r2 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][416] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r2);
		now.loom_r2 = 255;
#ifdef VAR_RANGES
		logval("loom_r2", ((int)now.loom_r2));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 225: // STATE 421 - /tmp/pt/out/carpet_loom.loom.pml:396 - [loom_r1 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][421] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r1);
		now.loom_r1 = 255;
#ifdef VAR_RANGES
		logval("loom_r1", ((int)now.loom_r1));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 226: // STATE 426 - /tmp/pt/out/carpet_loom.loom.pml:399 - [loom_r0 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][426] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r0);
		now.loom_r0 = 255;
#ifdef VAR_RANGES
		logval("loom_r0", ((int)now.loom_r0));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 227: // STATE 427 - /tmp/pt/out/carpet_loom.loom.pml:400 - [loom_r0 = 0] (0:0:1 - 0)
		IfNotBlocked
		reached[0][427] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r0);
		now.loom_r0 = 0;
#ifdef VAR_RANGES
		logval("loom_r0", ((int)now.loom_r0));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 228: // STATE 428 - /tmp/pt/out/carpet_loom.loom.pml:401 - [loom_r1 = 1] (0:0:1 - 0)
		IfNotBlocked
		reached[0][428] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r1);
		now.loom_r1 = 1;
#ifdef VAR_RANGES
		logval("loom_r1", ((int)now.loom_r1));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 229: // STATE 429 - /tmp/pt/out/carpet_loom.loom.pml:402 - [(((loom_r0==8)&&!(taken)))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][429] = 1;
		if (!(((((int)now.loom_r0)==8)&& !(((int)((P0 *)_this)->taken)))))
			continue;
		_m = 3; goto P999; /* 0 */
	case 230: // STATE 431 - /tmp/pt/out/carpet_loom.loom.pml:404 - [(!(((loom_r0==8)&&!(taken))))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][431] = 1;
		if (!( !(((((int)now.loom_r0)==8)&& !(((int)((P0 *)_this)->taken))))))
			continue;
		_m = 3; goto P999; /* 0 */
	case 231: // STATE 435 - /tmp/pt/out/carpet_loom.loom.pml:407 - [(((loom_r0==9)&&!(taken)))] (0:0:1 - 0)
		IfNotBlocked
		reached[0][435] = 1;
		if (!(((((int)now.loom_r0)==9)&& !(((int)((P0 *)_this)->taken)))))
			continue;
		if (TstOnly) return 1; /* TT */
		/* dead 1: taken */  (trpt+1)->bup.oval = ((P0 *)_this)->taken;
#ifdef HAS_CODE
		if (!readtrail)
#endif
			((P0 *)_this)->taken = 0;
		_m = 3; goto P999; /* 0 */
	case 232: // STATE 436 - /tmp/pt/out/carpet_loom.loom.pml:408 - [taken = 1] (0:0:2 - 0)
		IfNotBlocked
		reached[0][436] = 1;
		(trpt+1)->bup.ovals = grab_ints(2);
		(trpt+1)->bup.ovals[0] = ((int)((P0 *)_this)->taken);
		((P0 *)_this)->taken = 1;
#ifdef VAR_RANGES
		logval("machine_loom:taken", ((int)((P0 *)_this)->taken));
#endif
		;
		if (TstOnly) return 1; /* TT */
		/* dead 2: taken */  
#ifdef HAS_CODE
		if (!readtrail)
#endif
			((P0 *)_this)->taken = 0;
		_m = 3; goto P999; /* 0 */
	case 233: // STATE 437 - /tmp/pt/out/carpet_loom.loom.pml:410 - [((loom_r0==0))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][437] = 1;
		if (!((((int)now.loom_r0)==0)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 234: // STATE 438 - /tmp/pt/out/carpet_loom.loom.pml:412 - [((loom_r1==3))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][438] = 1;
		if (!((((int)now.loom_r1)==3)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 235: // STATE 439 - /tmp/pt/out/carpet_loom.loom.pml:413 - [loom_r2 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][439] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r2);
		now.loom_r2 = 255;
#ifdef VAR_RANGES
		logval("loom_r2", ((int)now.loom_r2));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 236: // STATE 444 - /tmp/pt/out/carpet_loom.loom.pml:416 - [loom_r1 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][444] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r1);
		now.loom_r1 = 255;
#ifdef VAR_RANGES
		logval("loom_r1", ((int)now.loom_r1));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 237: // STATE 449 - /tmp/pt/out/carpet_loom.loom.pml:419 - [loom_r0 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][449] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r0);
		now.loom_r0 = 255;
#ifdef VAR_RANGES
		logval("loom_r0", ((int)now.loom_r0));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 238: // STATE 450 - /tmp/pt/out/carpet_loom.loom.pml:420 - [loom_r0 = 0] (0:0:1 - 0)
		IfNotBlocked
		reached[0][450] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r0);
		now.loom_r0 = 0;
#ifdef VAR_RANGES
		logval("loom_r0", ((int)now.loom_r0));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 239: // STATE 451 - /tmp/pt/out/carpet_loom.loom.pml:421 - [loom_r1 = 1] (0:0:1 - 0)
		IfNotBlocked
		reached[0][451] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r1);
		now.loom_r1 = 1;
#ifdef VAR_RANGES
		logval("loom_r1", ((int)now.loom_r1));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 240: // STATE 452 - /tmp/pt/out/carpet_loom.loom.pml:422 - [(((loom_r0==9)&&!(taken)))] (0:0:1 - 0)
		IfNotBlocked
		reached[0][452] = 1;
		if (!(((((int)now.loom_r0)==9)&& !(((int)((P0 *)_this)->taken)))))
			continue;
		if (TstOnly) return 1; /* TT */
		/* dead 1: taken */  (trpt+1)->bup.oval = ((P0 *)_this)->taken;
#ifdef HAS_CODE
		if (!readtrail)
#endif
			((P0 *)_this)->taken = 0;
		_m = 3; goto P999; /* 0 */
	case 241: // STATE 454 - /tmp/pt/out/carpet_loom.loom.pml:424 - [(!(((loom_r0==9)&&!(taken))))] (0:0:1 - 0)
		IfNotBlocked
		reached[0][454] = 1;
		if (!( !(((((int)now.loom_r0)==9)&& !(((int)((P0 *)_this)->taken))))))
			continue;
		if (TstOnly) return 1; /* TT */
		/* dead 1: taken */  (trpt+1)->bup.oval = ((P0 *)_this)->taken;
#ifdef HAS_CODE
		if (!readtrail)
#endif
			((P0 *)_this)->taken = 0;
		_m = 3; goto P999; /* 0 */
	case 242: // STATE 459 - /tmp/pt/out/carpet_loom.loom.pml:427 - [taken = 0] (0:0:1 - 0)
		IfNotBlocked
		reached[0][459] = 1;
		(trpt+1)->bup.oval = ((int)((P0 *)_this)->taken);
		((P0 *)_this)->taken = 0;
#ifdef VAR_RANGES
		logval("machine_loom:taken", ((int)((P0 *)_this)->taken));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 243: // STATE 460 - /tmp/pt/out/carpet_loom.loom.pml:428 - [loom_events?6] (0:0:0 - 0)
		reached[0][460] = 1;
		if (q_len(now.loom_events) == 0) continue;

		XX=1;
		if (6 != qrecv(now.loom_events, 0, 0, 0)) continue;
		
#ifndef BFS_PAR
		if (q_flds[((Q0 *)qptr(now.loom_events-1))->_t] != 1)
			Uerror("wrong nr of msg fields in rcv");
#endif
		;
		qrecv(now.loom_events, XX-1, 0, 1);
		
#ifdef HAS_CODE
		if (readtrail && gui) {
			char simtmp[32];
			sprintf(simvals, "%d?", now.loom_events);
		sprintf(simtmp, "%d", 6); strcat(simvals, simtmp);		}
#endif
		;
		_m = 4; goto P999; /* 0 */
	case 244: // STATE 461 - /tmp/pt/out/carpet_loom.loom.pml:429 - [taken = 0] (0:0:1 - 0)
		IfNotBlocked
		reached[0][461] = 1;
		(trpt+1)->bup.oval = ((int)((P0 *)_this)->taken);
		((P0 *)_this)->taken = 0;
#ifdef VAR_RANGES
		logval("machine_loom:taken", ((int)((P0 *)_this)->taken));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 245: // STATE 462 - /tmp/pt/out/carpet_loom.loom.pml:431 - [(((loom_r0==0)&&!(taken)))] (0:0:1 - 0)
		IfNotBlocked
		reached[0][462] = 1;
		if (!(((((int)now.loom_r0)==0)&& !(((int)((P0 *)_this)->taken)))))
			continue;
		if (TstOnly) return 1; /* TT */
		/* dead 1: taken */  (trpt+1)->bup.oval = ((P0 *)_this)->taken;
#ifdef HAS_CODE
		if (!readtrail)
#endif
			((P0 *)_this)->taken = 0;
		_m = 3; goto P999; /* 0 */
	case 246: // STATE 463 - /tmp/pt/out/carpet_loom.loom.pml:432 - [taken = 1] (0:0:2 - 0)
		IfNotBlocked
		reached[0][463] = 1;
		(trpt+1)->bup.ovals = grab_ints(2);
		(trpt+1)->bup.ovals[0] = ((int)((P0 *)_this)->taken);
		((P0 *)_this)->taken = 1;
#ifdef VAR_RANGES
		logval("machine_loom:taken", ((int)((P0 *)_this)->taken));
#endif
		;
		if (TstOnly) return 1; /* TT */
		/* dead 2: taken */  
#ifdef HAS_CODE
		if (!readtrail)
#endif
			((P0 *)_this)->taken = 0;
		_m = 3; goto P999; /* 0 */
	case 247: // STATE 464 - /tmp/pt/out/carpet_loom.loom.pml:434 - [((loom_r0==0))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][464] = 1;
		if (!((((int)now.loom_r0)==0)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 248: // STATE 465 - /tmp/pt/out/carpet_loom.loom.pml:436 - [((loom_r1==3))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][465] = 1;
		if (!((((int)now.loom_r1)==3)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 249: // STATE 466 - /tmp/pt/out/carpet_loom.loom.pml:437 - [loom_r2 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][466] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r2);
		now.loom_r2 = 255;
#ifdef VAR_RANGES
		logval("loom_r2", ((int)now.loom_r2));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 250: // STATE 471 - /tmp/pt/out/carpet_loom.loom.pml:440 - [loom_r1 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][471] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r1);
		now.loom_r1 = 255;
#ifdef VAR_RANGES
		logval("loom_r1", ((int)now.loom_r1));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 251: // STATE 476 - /tmp/pt/out/carpet_loom.loom.pml:443 - [loom_r0 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][476] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r0);
		now.loom_r0 = 255;
#ifdef VAR_RANGES
		logval("loom_r0", ((int)now.loom_r0));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 252: // STATE 477 - /tmp/pt/out/carpet_loom.loom.pml:444 - [loom_r0 = 8] (0:0:1 - 0)
		IfNotBlocked
		reached[0][477] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r0);
		now.loom_r0 = 8;
#ifdef VAR_RANGES
		logval("loom_r0", ((int)now.loom_r0));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 253: // STATE 478 - /tmp/pt/out/carpet_loom.loom.pml:445 - [(!(((loom_r0==0)&&!(taken))))] (0:0:1 - 0)
		IfNotBlocked
		reached[0][478] = 1;
		if (!( !(((((int)now.loom_r0)==0)&& !(((int)((P0 *)_this)->taken))))))
			continue;
		if (TstOnly) return 1; /* TT */
		/* dead 1: taken */  (trpt+1)->bup.oval = ((P0 *)_this)->taken;
#ifdef HAS_CODE
		if (!readtrail)
#endif
			((P0 *)_this)->taken = 0;
		_m = 3; goto P999; /* 0 */
	case 254: // STATE 483 - /tmp/pt/out/carpet_loom.loom.pml:448 - [taken = 0] (0:0:1 - 0)
		IfNotBlocked
		reached[0][483] = 1;
		(trpt+1)->bup.oval = ((int)((P0 *)_this)->taken);
		((P0 *)_this)->taken = 0;
#ifdef VAR_RANGES
		logval("machine_loom:taken", ((int)((P0 *)_this)->taken));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 255: // STATE 484 - /tmp/pt/out/carpet_loom.loom.pml:449 - [loom_events?7] (0:0:0 - 0)
		reached[0][484] = 1;
		if (q_len(now.loom_events) == 0) continue;

		XX=1;
		if (7 != qrecv(now.loom_events, 0, 0, 0)) continue;
		
#ifndef BFS_PAR
		if (q_flds[((Q0 *)qptr(now.loom_events-1))->_t] != 1)
			Uerror("wrong nr of msg fields in rcv");
#endif
		;
		qrecv(now.loom_events, XX-1, 0, 1);
		
#ifdef HAS_CODE
		if (readtrail && gui) {
			char simtmp[32];
			sprintf(simvals, "%d?", now.loom_events);
		sprintf(simtmp, "%d", 7); strcat(simvals, simtmp);		}
#endif
		;
		_m = 4; goto P999; /* 0 */
	case 256: // STATE 485 - /tmp/pt/out/carpet_loom.loom.pml:450 - [taken = 0] (0:0:1 - 0)
		IfNotBlocked
		reached[0][485] = 1;
		(trpt+1)->bup.oval = ((int)((P0 *)_this)->taken);
		((P0 *)_this)->taken = 0;
#ifdef VAR_RANGES
		logval("machine_loom:taken", ((int)((P0 *)_this)->taken));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 257: // STATE 486 - /tmp/pt/out/carpet_loom.loom.pml:452 - [(((loom_r0==0)&&!(taken)))] (0:0:1 - 0)
		IfNotBlocked
		reached[0][486] = 1;
		if (!(((((int)now.loom_r0)==0)&& !(((int)((P0 *)_this)->taken)))))
			continue;
		if (TstOnly) return 1; /* TT */
		/* dead 1: taken */  (trpt+1)->bup.oval = ((P0 *)_this)->taken;
#ifdef HAS_CODE
		if (!readtrail)
#endif
			((P0 *)_this)->taken = 0;
		_m = 3; goto P999; /* 0 */
	case 258: // STATE 487 - /tmp/pt/out/carpet_loom.loom.pml:453 - [taken = 1] (0:0:2 - 0)
		IfNotBlocked
		reached[0][487] = 1;
		(trpt+1)->bup.ovals = grab_ints(2);
		(trpt+1)->bup.ovals[0] = ((int)((P0 *)_this)->taken);
		((P0 *)_this)->taken = 1;
#ifdef VAR_RANGES
		logval("machine_loom:taken", ((int)((P0 *)_this)->taken));
#endif
		;
		if (TstOnly) return 1; /* TT */
		/* dead 2: taken */  
#ifdef HAS_CODE
		if (!readtrail)
#endif
			((P0 *)_this)->taken = 0;
		_m = 3; goto P999; /* 0 */
	case 259: // STATE 488 - /tmp/pt/out/carpet_loom.loom.pml:455 - [((loom_r0==0))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][488] = 1;
		if (!((((int)now.loom_r0)==0)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 260: // STATE 489 - /tmp/pt/out/carpet_loom.loom.pml:457 - [((loom_r1==3))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][489] = 1;
		if (!((((int)now.loom_r1)==3)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 261: // STATE 490 - /tmp/pt/out/carpet_loom.loom.pml:458 - [loom_r2 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][490] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r2);
		now.loom_r2 = 255;
#ifdef VAR_RANGES
		logval("loom_r2", ((int)now.loom_r2));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 262: // STATE 495 - /tmp/pt/out/carpet_loom.loom.pml:461 - [loom_r1 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][495] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r1);
		now.loom_r1 = 255;
#ifdef VAR_RANGES
		logval("loom_r1", ((int)now.loom_r1));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 263: // STATE 500 - /tmp/pt/out/carpet_loom.loom.pml:464 - [loom_r0 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][500] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r0);
		now.loom_r0 = 255;
#ifdef VAR_RANGES
		logval("loom_r0", ((int)now.loom_r0));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 264: // STATE 501 - /tmp/pt/out/carpet_loom.loom.pml:465 - [loom_r0 = 9] (0:0:1 - 0)
		IfNotBlocked
		reached[0][501] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r0);
		now.loom_r0 = 9;
#ifdef VAR_RANGES
		logval("loom_r0", ((int)now.loom_r0));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 265: // STATE 502 - /tmp/pt/out/carpet_loom.loom.pml:466 - [(!(((loom_r0==0)&&!(taken))))] (0:0:1 - 0)
		IfNotBlocked
		reached[0][502] = 1;
		if (!( !(((((int)now.loom_r0)==0)&& !(((int)((P0 *)_this)->taken))))))
			continue;
		if (TstOnly) return 1; /* TT */
		/* dead 1: taken */  (trpt+1)->bup.oval = ((P0 *)_this)->taken;
#ifdef HAS_CODE
		if (!readtrail)
#endif
			((P0 *)_this)->taken = 0;
		_m = 3; goto P999; /* 0 */
	case 266: // STATE 507 - /tmp/pt/out/carpet_loom.loom.pml:469 - [taken = 0] (0:0:1 - 0)
		IfNotBlocked
		reached[0][507] = 1;
		(trpt+1)->bup.oval = ((int)((P0 *)_this)->taken);
		((P0 *)_this)->taken = 0;
#ifdef VAR_RANGES
		logval("machine_loom:taken", ((int)((P0 *)_this)->taken));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 267: // STATE 508 - /tmp/pt/out/carpet_loom.loom.pml:470 - [((loom_wants_final||loom_wants_initial))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][508] = 1;
		if (!((((int)now.loom_wants_final)||((int)now.loom_wants_initial))))
			continue;
		_m = 3; goto P999; /* 0 */
	case 268: // STATE 510 - /tmp/pt/out/carpet_loom.loom.pml:471 - [(((loom_r0==10)&&empty(loom_events)))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][510] = 1;
		if (!(((((int)now.loom_r0)==10)&&(q_len(now.loom_events)==0))))
			continue;
		_m = 3; goto P999; /* 0 */
	case 269: // STATE 515 - /tmp/pt/out/carpet_loom.loom.pml:475 - [(((nempty(loom_events)||loom_wants_initial)||loom_wants_final))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][515] = 1;
		if (!((((q_len(now.loom_events)>0)||((int)now.loom_wants_initial))||((int)now.loom_wants_final))))
			continue;
		_m = 3; goto P999; /* 0 */
	case 270: // STATE 517 - /tmp/pt/out/carpet_loom.loom.pml:479 - [((loom_wants_final&&!((loom_r0==10))))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][517] = 1;
		if (!((((int)now.loom_wants_final)&& !((((int)now.loom_r0)==10)))))
			continue;
		_m = 3; goto P999; /* 0 */
	case 271: // STATE 518 - /tmp/pt/out/carpet_loom.loom.pml:481 - [((loom_r0==0))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][518] = 1;
		if (!((((int)now.loom_r0)==0)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 272: // STATE 519 - /tmp/pt/out/carpet_loom.loom.pml:483 - [((loom_r1==3))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][519] = 1;
		if (!((((int)now.loom_r1)==3)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 273: // STATE 520 - /tmp/pt/out/carpet_loom.loom.pml:484 - [loom_r2 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][520] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r2);
		now.loom_r2 = 255;
#ifdef VAR_RANGES
		logval("loom_r2", ((int)now.loom_r2));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 274: // STATE 525 - /tmp/pt/out/carpet_loom.loom.pml:487 - [loom_r1 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][525] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r1);
		now.loom_r1 = 255;
#ifdef VAR_RANGES
		logval("loom_r1", ((int)now.loom_r1));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 275: // STATE 530 - /tmp/pt/out/carpet_loom.loom.pml:490 - [loom_r0 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][530] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r0);
		now.loom_r0 = 255;
#ifdef VAR_RANGES
		logval("loom_r0", ((int)now.loom_r0));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 276: // STATE 531 - /tmp/pt/out/carpet_loom.loom.pml:491 - [loom_wants_final = 0] (0:0:1 - 0)
		IfNotBlocked
		reached[0][531] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_wants_final);
		now.loom_wants_final = 0;
#ifdef VAR_RANGES
		logval("loom_wants_final", ((int)now.loom_wants_final));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 277: // STATE 532 - /tmp/pt/out/carpet_loom.loom.pml:492 - [loom_error = 0] (0:0:1 - 0)
		IfNotBlocked
		reached[0][532] = 1;
		(trpt+1)->bup.oval = ((int)loom_error);
		loom_error = 0;
#ifdef VAR_RANGES
		logval("loom_error", ((int)loom_error));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 278: // STATE 533 - /tmp/pt/out/carpet_loom.loom.pml:493 - [at = 0] (0:0:1 - 0)
		IfNotBlocked
		reached[0][533] = 1;
		(trpt+1)->bup.oval = ((int)((P0 *)_this)->at);
		((P0 *)_this)->at = 0;
#ifdef VAR_RANGES
		logval("machine_loom:at", ((int)((P0 *)_this)->at));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 279: // STATE 534 - /tmp/pt/out/carpet_loom.loom.pml:494 - [loom_r0 = 10] (0:0:1 - 0)
		IfNotBlocked
		reached[0][534] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r0);
		now.loom_r0 = 10;
#ifdef VAR_RANGES
		logval("loom_r0", ((int)now.loom_r0));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 280: // STATE 536 - /tmp/pt/out/carpet_loom.loom.pml:496 - [((loom_wants_final&&(loom_r0==10)))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][536] = 1;
		if (!((((int)now.loom_wants_final)&&(((int)now.loom_r0)==10))))
			continue;
		_m = 3; goto P999; /* 0 */
	case 281: // STATE 537 - /tmp/pt/out/carpet_loom.loom.pml:496 - [loom_wants_final = 0] (0:0:1 - 0)
		IfNotBlocked
		reached[0][537] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_wants_final);
		now.loom_wants_final = 0;
#ifdef VAR_RANGES
		logval("loom_wants_final", ((int)now.loom_wants_final));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 282: // STATE 538 - /tmp/pt/out/carpet_loom.loom.pml:497 - [((loom_wants_initial&&!((loom_r0==10))))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][538] = 1;
		if (!((((int)now.loom_wants_initial)&& !((((int)now.loom_r0)==10)))))
			continue;
		_m = 3; goto P999; /* 0 */
	case 283: // STATE 539 - /tmp/pt/out/carpet_loom.loom.pml:497 - [loom_wants_initial = 0] (0:0:1 - 0)
		IfNotBlocked
		reached[0][539] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_wants_initial);
		now.loom_wants_initial = 0;
#ifdef VAR_RANGES
		logval("loom_wants_initial", ((int)now.loom_wants_initial));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 284: // STATE 540 - /tmp/pt/out/carpet_loom.loom.pml:498 - [((loom_wants_initial&&(loom_r0==10)))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][540] = 1;
		if (!((((int)now.loom_wants_initial)&&(((int)now.loom_r0)==10))))
			continue;
		_m = 3; goto P999; /* 0 */
	case 285: // STATE 541 - /tmp/pt/out/carpet_loom.loom.pml:500 - [((loom_r0==0))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][541] = 1;
		if (!((((int)now.loom_r0)==0)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 286: // STATE 542 - /tmp/pt/out/carpet_loom.loom.pml:502 - [((loom_r1==3))] (0:0:0 - 0)
		IfNotBlocked
		reached[0][542] = 1;
		if (!((((int)now.loom_r1)==3)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 287: // STATE 543 - /tmp/pt/out/carpet_loom.loom.pml:503 - [loom_r2 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][543] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r2);
		now.loom_r2 = 255;
#ifdef VAR_RANGES
		logval("loom_r2", ((int)now.loom_r2));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 288: // STATE 548 - /tmp/pt/out/carpet_loom.loom.pml:506 - [loom_r1 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][548] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r1);
		now.loom_r1 = 255;
#ifdef VAR_RANGES
		logval("loom_r1", ((int)now.loom_r1));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 289: // STATE 553 - /tmp/pt/out/carpet_loom.loom.pml:509 - [loom_r0 = 255] (0:0:1 - 0)
		IfNotBlocked
		reached[0][553] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r0);
		now.loom_r0 = 255;
#ifdef VAR_RANGES
		logval("loom_r0", ((int)now.loom_r0));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 290: // STATE 554 - /tmp/pt/out/carpet_loom.loom.pml:510 - [loom_wants_initial = 0] (0:0:1 - 0)
		IfNotBlocked
		reached[0][554] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_wants_initial);
		now.loom_wants_initial = 0;
#ifdef VAR_RANGES
		logval("loom_wants_initial", ((int)now.loom_wants_initial));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 291: // STATE 555 - /tmp/pt/out/carpet_loom.loom.pml:511 - [at = 0] (0:0:1 - 0)
		IfNotBlocked
		reached[0][555] = 1;
		(trpt+1)->bup.oval = ((int)((P0 *)_this)->at);
		((P0 *)_this)->at = 0;
#ifdef VAR_RANGES
		logval("machine_loom:at", ((int)((P0 *)_this)->at));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 292: // STATE 556 - /tmp/pt/out/carpet_loom.loom.pml:512 - [loom_r0 = 0] (0:0:1 - 0)
		IfNotBlocked
		reached[0][556] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r0);
		now.loom_r0 = 0;
#ifdef VAR_RANGES
		logval("loom_r0", ((int)now.loom_r0));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 293: // STATE 557 - /tmp/pt/out/carpet_loom.loom.pml:513 - [loom_r1 = 1] (0:0:1 - 0)
		IfNotBlocked
		reached[0][557] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_r1);
		now.loom_r1 = 1;
#ifdef VAR_RANGES
		logval("loom_r1", ((int)now.loom_r1));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 294: // STATE 562 - /tmp/pt/out/carpet_loom.loom.pml:518 - [loom_error = 1] (0:0:1 - 0)
		IfNotBlocked
		reached[0][562] = 1;
		(trpt+1)->bup.oval = ((int)loom_error);
		loom_error = 1;
#ifdef VAR_RANGES
		logval("loom_error", ((int)loom_error));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 295: // STATE 563 - /tmp/pt/out/carpet_loom.loom.pml:519 - [at = 0] (0:0:1 - 0)
		IfNotBlocked
		reached[0][563] = 1;
		(trpt+1)->bup.oval = ((int)((P0 *)_this)->at);
		((P0 *)_this)->at = 0;
#ifdef VAR_RANGES
		logval("machine_loom:at", ((int)((P0 *)_this)->at));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 296: // STATE 564 - /tmp/pt/out/carpet_loom.loom.pml:522 - [loom_events?_] (0:0:1 - 0)
		reached[0][564] = 1;
		if (q_len(now.loom_events) == 0) continue;

		XX=1;
		(trpt+1)->bup.oval = qrecv(now.loom_events, XX-1, 0, 0);
		;
		qrecv(now.loom_events, XX-1, 0, 1);
		
#ifdef HAS_CODE
		if (readtrail && gui) {
			char simtmp[32];
			sprintf(simvals, "%d?", now.loom_events);
		sprintf(simtmp, "%d", ((int)_)); strcat(simvals, simtmp);		}
#endif
		;
		_m = 4; goto P999; /* 0 */
	case 297: // STATE 565 - /tmp/pt/out/carpet_loom.loom.pml:523 - [(loom_wants_initial)] (0:0:0 - 0)
		IfNotBlocked
		reached[0][565] = 1;
		if (!(((int)now.loom_wants_initial)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 298: // STATE 566 - /tmp/pt/out/carpet_loom.loom.pml:523 - [loom_wants_initial = 0] (0:0:1 - 0)
		IfNotBlocked
		reached[0][566] = 1;
		(trpt+1)->bup.oval = ((int)now.loom_wants_initial);
		now.loom_wants_initial = 0;
#ifdef VAR_RANGES
		logval("loom_wants_initial", ((int)now.loom_wants_initial));
#endif
		;
		_m = 3; goto P999; /* 0 */
	case 299: // STATE 567 - /tmp/pt/out/carpet_loom.loom.pml:524 - [(loom_wants_final)] (0:0:0 - 0)
		IfNotBlocked
		reached[0][567] = 1;
		if (!(((int)now.loom_wants_final)))
			continue;
		_m = 3; goto P999; /* 0 */
	case 300: // STATE 573 - /tmp/pt/out/carpet_loom.loom.pml:528 - [-end-] (0:0:0 - 0)
		IfNotBlocked
		reached[0][573] = 1;
		if (!delproc(1, II)) continue;
		_m = 3; goto P999; /* 0 */
	case  _T5:	/* np_ */
		if (!((!(trpt->o_pm&4) && !(trpt->tau&128))))
			continue;
		/* else fall through */
	case  _T2:	/* true */
		_m = 3; goto P999;
#undef rand
	}

