#ifdef PEG
struct T_SRC {
	char *fl; int ln;
} T_SRC[NTRANS];

void
tr_2_src(int m, char *file, int ln)
{	T_SRC[m].fl = file;
	T_SRC[m].ln = ln;
}

void
putpeg(int n, int m)
{	printf("%5d	trans %4d ", m, n);
	printf("%s:%d\n",
		T_SRC[n].fl, T_SRC[n].ln);
}
#else
#define tr_2_src(m,f,l)
#endif

void
settable(void)
{	Trans *T;
	Trans *settr(int, int, int, int, int, char *, int, int, int);

	trans = (Trans ***) emalloc(4*sizeof(Trans **));

	/* proctype 2: scheduler */

	trans[2] = (Trans **) emalloc(7*sizeof(Trans *));

	trans[2][4]	= settr(660,0,3,1,0,".(goto)", 0, 2, 0);
	T = trans[2][3] = settr(659,0,0,0,0,"DO", 0, 2, 0);
		/* /tmp/pt/out/carpet_loom.loom.pml:613 */
	    T->nxt	= settr(659,0,1,0,0,"DO", 0, 2, 0);
		/* /tmp/pt/out/carpet_loom.loom.pml:613 */
	trans[2][1]	= settr(657,0,2,3,0,"(!(loom_go))", 1, 2, 0);
		tr_2_src(3, "/tmp/pt/out/carpet_loom.loom.pml", 614);
	trans[2][2]	= settr(658,0,3,4,4,"loom_go = 1", 1, 2, 0);
		tr_2_src(4, "/tmp/pt/out/carpet_loom.loom.pml", 614);
	trans[2][5]	= settr(661,0,6,1,0,"break", 0, 2, 0);
	trans[2][6]	= settr(662,0,0,5,5,"-end-", 0, 3500, 0);
		tr_2_src(5, "/tmp/pt/out/carpet_loom.loom.pml", 616);

	/* proctype 1: activity_world */

	trans[1] = (Trans **) emalloc(85*sizeof(Trans *));

	trans[1][82]	= settr(654,0,81,1,0,".(goto)", 0, 2, 0);
	T = trans[1][81] = settr(653,0,0,0,0,"DO", 0, 2, 0);
		/* /tmp/pt/out/carpet_loom.loom.pml:531 */
	T = T->nxt	= settr(653,0,10,0,0,"DO", 0, 2, 0);
		/* /tmp/pt/out/carpet_loom.loom.pml:531 */
	T = T->nxt	= settr(653,0,20,0,0,"DO", 0, 2, 0);
		/* /tmp/pt/out/carpet_loom.loom.pml:531 */
	T = T->nxt	= settr(653,0,30,0,0,"DO", 0, 2, 0);
		/* /tmp/pt/out/carpet_loom.loom.pml:531 */
	T = T->nxt	= settr(653,0,40,0,0,"DO", 0, 2, 0);
		/* /tmp/pt/out/carpet_loom.loom.pml:531 */
	T = T->nxt	= settr(653,0,50,0,0,"DO", 0, 2, 0);
		/* /tmp/pt/out/carpet_loom.loom.pml:531 */
	T = T->nxt	= settr(653,0,60,0,0,"DO", 0, 2, 0);
		/* /tmp/pt/out/carpet_loom.loom.pml:531 */
	T = T->nxt	= settr(653,0,70,0,0,"DO", 0, 2, 0);
		/* /tmp/pt/out/carpet_loom.loom.pml:531 */
	    T->nxt	= settr(653,0,80,0,0,"DO", 0, 2, 0);
		/* /tmp/pt/out/carpet_loom.loom.pml:531 */
	T = trans[ 1][10] = settr(582,2,0,0,0,"ATOMIC", 1, 2, 0);
		/* /tmp/pt/out/carpet_loom.loom.pml:532 */
	T->nxt	= settr(582,2,1,0,0,"ATOMIC", 1, 3, 0);
		/* /tmp/pt/out/carpet_loom.loom.pml:532 */
	trans[1][1]	= settr(573,2,7,6,0,"(((!(quiet)&&(len(loom_events)<=(8/2)))&&(((loom_r1==7)||(loom_r0==8))||(loom_r0==9))))", 1, 3, 0);
		tr_2_src(6, "/tmp/pt/out/carpet_loom.loom.pml", 532);
	T = trans[1][7] = settr(579,2,0,0,0,"IF", 1, 3, 0);
		/* /tmp/pt/out/carpet_loom.loom.pml:533 */
	T = T->nxt	= settr(579,2,2,0,0,"IF", 1, 3, 0);
		/* /tmp/pt/out/carpet_loom.loom.pml:533 */
	    T->nxt	= settr(579,2,5,0,0,"IF", 1, 3, 0);
		/* /tmp/pt/out/carpet_loom.loom.pml:533 */
	trans[1][2]	= settr(574,2,3,7,0,"(loom_started)", 1, 3, 0);
		tr_2_src(7, "/tmp/pt/out/carpet_loom.loom.pml", 534);
	trans[1][3]	= settr(575,2,4,8,0,"assert(nfull(loom_events))", 1, 3, 0);
		tr_2_src(8, "/tmp/pt/out/carpet_loom.loom.pml", 534);
	trans[1][4]	= settr(576,2,8,9,9,"loom_events!5", 1, 3, 0);
		tr_2_src(9, "/tmp/pt/out/carpet_loom.loom.pml", 534);
	trans[1][8]	= settr(580,2,9,1,0,".(goto)", 1, 3, 0);
	trans[1][5]	= settr(577,2,6,2,0,"else", 1, 3, 0);
	trans[1][6]	= settr(578,2,8,1,0,"(1)", 1, 3, 0);
	trans[1][9]	= settr(581,0,81,1,0,"(1)", 1, 3, 0);
	T = trans[ 1][20] = settr(592,2,0,0,0,"ATOMIC", 1, 2, 0);
		/* /tmp/pt/out/carpet_loom.loom.pml:539 */
	T->nxt	= settr(592,2,11,0,0,"ATOMIC", 1, 3, 0);
		/* /tmp/pt/out/carpet_loom.loom.pml:539 */
	trans[1][11]	= settr(583,2,17,10,0,"(((!(quiet)&&(len(loom_events)<=(8/2)))&&(loom_r1==2)))", 1, 3, 0);
		tr_2_src(10, "/tmp/pt/out/carpet_loom.loom.pml", 539);
	T = trans[1][17] = settr(589,2,0,0,0,"IF", 1, 3, 0);
		/* /tmp/pt/out/carpet_loom.loom.pml:540 */
	T = T->nxt	= settr(589,2,12,0,0,"IF", 1, 3, 0);
		/* /tmp/pt/out/carpet_loom.loom.pml:540 */
	    T->nxt	= settr(589,2,15,0,0,"IF", 1, 3, 0);
		/* /tmp/pt/out/carpet_loom.loom.pml:540 */
	trans[1][12]	= settr(584,2,13,11,0,"(loom_started)", 1, 3, 0);
		tr_2_src(11, "/tmp/pt/out/carpet_loom.loom.pml", 541);
	trans[1][13]	= settr(585,2,14,12,0,"assert(nfull(loom_events))", 1, 3, 0);
		tr_2_src(12, "/tmp/pt/out/carpet_loom.loom.pml", 541);
	trans[1][14]	= settr(586,2,18,13,13,"loom_events!0", 1, 3, 0);
		tr_2_src(13, "/tmp/pt/out/carpet_loom.loom.pml", 541);
	trans[1][18]	= settr(590,2,19,1,0,".(goto)", 1, 3, 0);
	trans[1][15]	= settr(587,2,16,2,0,"else", 1, 3, 0);
	trans[1][16]	= settr(588,2,18,1,0,"(1)", 1, 3, 0);
	trans[1][19]	= settr(591,0,81,1,0,"(1)", 1, 3, 0);
	T = trans[ 1][30] = settr(602,2,0,0,0,"ATOMIC", 1, 2, 0);
		/* /tmp/pt/out/carpet_loom.loom.pml:546 */
	T->nxt	= settr(602,2,21,0,0,"ATOMIC", 1, 3, 0);
		/* /tmp/pt/out/carpet_loom.loom.pml:546 */
	trans[1][21]	= settr(593,2,27,14,0,"(((!(quiet)&&(len(loom_events)<=(8/2)))&&(loom_r1==3)))", 1, 3, 0);
		tr_2_src(14, "/tmp/pt/out/carpet_loom.loom.pml", 546);
	T = trans[1][27] = settr(599,2,0,0,0,"IF", 1, 3, 0);
		/* /tmp/pt/out/carpet_loom.loom.pml:547 */
	T = T->nxt	= settr(599,2,22,0,0,"IF", 1, 3, 0);
		/* /tmp/pt/out/carpet_loom.loom.pml:547 */
	    T->nxt	= settr(599,2,25,0,0,"IF", 1, 3, 0);
		/* /tmp/pt/out/carpet_loom.loom.pml:547 */
	trans[1][22]	= settr(594,2,23,15,0,"(loom_started)", 1, 3, 0);
		tr_2_src(15, "/tmp/pt/out/carpet_loom.loom.pml", 548);
	trans[1][23]	= settr(595,2,24,16,0,"assert(nfull(loom_events))", 1, 3, 0);
		tr_2_src(16, "/tmp/pt/out/carpet_loom.loom.pml", 548);
	trans[1][24]	= settr(596,2,28,17,17,"loom_events!3", 1, 3, 0);
		tr_2_src(17, "/tmp/pt/out/carpet_loom.loom.pml", 548);
	trans[1][28]	= settr(600,2,29,1,0,".(goto)", 1, 3, 0);
	trans[1][25]	= settr(597,2,26,2,0,"else", 1, 3, 0);
	trans[1][26]	= settr(598,2,28,1,0,"(1)", 1, 3, 0);
	trans[1][29]	= settr(601,0,81,1,0,"(1)", 1, 3, 0);
	T = trans[ 1][40] = settr(612,2,0,0,0,"ATOMIC", 1, 2, 0);
		/* /tmp/pt/out/carpet_loom.loom.pml:553 */
	T->nxt	= settr(612,2,31,0,0,"ATOMIC", 1, 3, 0);
		/* /tmp/pt/out/carpet_loom.loom.pml:553 */
	trans[1][31]	= settr(603,2,37,18,0,"(((!(quiet)&&(len(loom_events)<=(8/2)))&&(loom_r1==3)))", 1, 3, 0);
		tr_2_src(18, "/tmp/pt/out/carpet_loom.loom.pml", 553);
	T = trans[1][37] = settr(609,2,0,0,0,"IF", 1, 3, 0);
		/* /tmp/pt/out/carpet_loom.loom.pml:554 */
	T = T->nxt	= settr(609,2,32,0,0,"IF", 1, 3, 0);
		/* /tmp/pt/out/carpet_loom.loom.pml:554 */
	    T->nxt	= settr(609,2,35,0,0,"IF", 1, 3, 0);
		/* /tmp/pt/out/carpet_loom.loom.pml:554 */
	trans[1][32]	= settr(604,2,33,19,0,"(loom_started)", 1, 3, 0);
		tr_2_src(19, "/tmp/pt/out/carpet_loom.loom.pml", 555);
	trans[1][33]	= settr(605,2,34,20,0,"assert(nfull(loom_events))", 1, 3, 0);
		tr_2_src(20, "/tmp/pt/out/carpet_loom.loom.pml", 555);
	trans[1][34]	= settr(606,2,38,21,21,"loom_events!2", 1, 3, 0);
		tr_2_src(21, "/tmp/pt/out/carpet_loom.loom.pml", 555);
	trans[1][38]	= settr(610,2,39,1,0,".(goto)", 1, 3, 0);
	trans[1][35]	= settr(607,2,36,2,0,"else", 1, 3, 0);
	trans[1][36]	= settr(608,2,38,1,0,"(1)", 1, 3, 0);
	trans[1][39]	= settr(611,0,81,1,0,"(1)", 1, 3, 0);
	T = trans[ 1][50] = settr(622,2,0,0,0,"ATOMIC", 1, 2, 0);
		/* /tmp/pt/out/carpet_loom.loom.pml:560 */
	T->nxt	= settr(622,2,41,0,0,"ATOMIC", 1, 3, 0);
		/* /tmp/pt/out/carpet_loom.loom.pml:560 */
	trans[1][41]	= settr(613,2,47,22,0,"(((!(quiet)&&(len(loom_events)<=(8/2)))&&(loom_r0==0)))", 1, 3, 0);
		tr_2_src(22, "/tmp/pt/out/carpet_loom.loom.pml", 560);
	T = trans[1][47] = settr(619,2,0,0,0,"IF", 1, 3, 0);
		/* /tmp/pt/out/carpet_loom.loom.pml:561 */
	T = T->nxt	= settr(619,2,42,0,0,"IF", 1, 3, 0);
		/* /tmp/pt/out/carpet_loom.loom.pml:561 */
	    T->nxt	= settr(619,2,45,0,0,"IF", 1, 3, 0);
		/* /tmp/pt/out/carpet_loom.loom.pml:561 */
	trans[1][42]	= settr(614,2,43,23,0,"(loom_started)", 1, 3, 0);
		tr_2_src(23, "/tmp/pt/out/carpet_loom.loom.pml", 562);
	trans[1][43]	= settr(615,2,44,24,0,"assert(nfull(loom_events))", 1, 3, 0);
		tr_2_src(24, "/tmp/pt/out/carpet_loom.loom.pml", 562);
	trans[1][44]	= settr(616,2,48,25,25,"loom_events!6", 1, 3, 0);
		tr_2_src(25, "/tmp/pt/out/carpet_loom.loom.pml", 562);
	trans[1][48]	= settr(620,2,49,1,0,".(goto)", 1, 3, 0);
	trans[1][45]	= settr(617,2,46,2,0,"else", 1, 3, 0);
	trans[1][46]	= settr(618,2,48,1,0,"(1)", 1, 3, 0);
	trans[1][49]	= settr(621,0,81,1,0,"(1)", 1, 3, 0);
	T = trans[ 1][60] = settr(632,2,0,0,0,"ATOMIC", 1, 2, 0);
		/* /tmp/pt/out/carpet_loom.loom.pml:567 */
	T->nxt	= settr(632,2,51,0,0,"ATOMIC", 1, 3, 0);
		/* /tmp/pt/out/carpet_loom.loom.pml:567 */
	trans[1][51]	= settr(623,2,57,26,0,"(((!(quiet)&&(len(loom_events)<=(8/2)))&&(loom_r0==0)))", 1, 3, 0);
		tr_2_src(26, "/tmp/pt/out/carpet_loom.loom.pml", 567);
	T = trans[1][57] = settr(629,2,0,0,0,"IF", 1, 3, 0);
		/* /tmp/pt/out/carpet_loom.loom.pml:568 */
	T = T->nxt	= settr(629,2,52,0,0,"IF", 1, 3, 0);
		/* /tmp/pt/out/carpet_loom.loom.pml:568 */
	    T->nxt	= settr(629,2,55,0,0,"IF", 1, 3, 0);
		/* /tmp/pt/out/carpet_loom.loom.pml:568 */
	trans[1][52]	= settr(624,2,53,27,0,"(loom_started)", 1, 3, 0);
		tr_2_src(27, "/tmp/pt/out/carpet_loom.loom.pml", 569);
	trans[1][53]	= settr(625,2,54,28,0,"assert(nfull(loom_events))", 1, 3, 0);
		tr_2_src(28, "/tmp/pt/out/carpet_loom.loom.pml", 569);
	trans[1][54]	= settr(626,2,58,29,29,"loom_events!7", 1, 3, 0);
		tr_2_src(29, "/tmp/pt/out/carpet_loom.loom.pml", 569);
	trans[1][58]	= settr(630,2,59,1,0,".(goto)", 1, 3, 0);
	trans[1][55]	= settr(627,2,56,2,0,"else", 1, 3, 0);
	trans[1][56]	= settr(628,2,58,1,0,"(1)", 1, 3, 0);
	trans[1][59]	= settr(631,0,81,1,0,"(1)", 1, 3, 0);
	T = trans[ 1][70] = settr(642,2,0,0,0,"ATOMIC", 1, 2, 0);
		/* /tmp/pt/out/carpet_loom.loom.pml:574 */
	T->nxt	= settr(642,2,61,0,0,"ATOMIC", 1, 3, 0);
		/* /tmp/pt/out/carpet_loom.loom.pml:574 */
	trans[1][61]	= settr(633,2,67,30,0,"(((!(quiet)&&(len(loom_events)<=(8/2)))&&(((loom_r1==3)||(loom_r1==6))||(loom_r1==6))))", 1, 3, 0);
		tr_2_src(30, "/tmp/pt/out/carpet_loom.loom.pml", 574);
	T = trans[1][67] = settr(639,2,0,0,0,"IF", 1, 3, 0);
		/* /tmp/pt/out/carpet_loom.loom.pml:575 */
	T = T->nxt	= settr(639,2,62,0,0,"IF", 1, 3, 0);
		/* /tmp/pt/out/carpet_loom.loom.pml:575 */
	    T->nxt	= settr(639,2,65,0,0,"IF", 1, 3, 0);
		/* /tmp/pt/out/carpet_loom.loom.pml:575 */
	trans[1][62]	= settr(634,2,63,31,0,"(loom_started)", 1, 3, 0);
		tr_2_src(31, "/tmp/pt/out/carpet_loom.loom.pml", 576);
	trans[1][63]	= settr(635,2,64,32,0,"assert(nfull(loom_events))", 1, 3, 0);
		tr_2_src(32, "/tmp/pt/out/carpet_loom.loom.pml", 576);
	trans[1][64]	= settr(636,2,68,33,33,"loom_events!4", 1, 3, 0);
		tr_2_src(33, "/tmp/pt/out/carpet_loom.loom.pml", 576);
	trans[1][68]	= settr(640,2,69,1,0,".(goto)", 1, 3, 0);
	trans[1][65]	= settr(637,2,66,2,0,"else", 1, 3, 0);
	trans[1][66]	= settr(638,2,68,1,0,"(1)", 1, 3, 0);
	trans[1][69]	= settr(641,0,81,1,0,"(1)", 1, 3, 0);
	T = trans[ 1][80] = settr(652,2,0,0,0,"ATOMIC", 1, 2, 0);
		/* /tmp/pt/out/carpet_loom.loom.pml:581 */
	T->nxt	= settr(652,2,71,0,0,"ATOMIC", 1, 3, 0);
		/* /tmp/pt/out/carpet_loom.loom.pml:581 */
	trans[1][71]	= settr(643,2,77,34,0,"(((!(quiet)&&(len(loom_events)<=(8/2)))&&(loom_r1==3)))", 1, 3, 0);
		tr_2_src(34, "/tmp/pt/out/carpet_loom.loom.pml", 581);
	T = trans[1][77] = settr(649,2,0,0,0,"IF", 1, 3, 0);
		/* /tmp/pt/out/carpet_loom.loom.pml:582 */
	T = T->nxt	= settr(649,2,72,0,0,"IF", 1, 3, 0);
		/* /tmp/pt/out/carpet_loom.loom.pml:582 */
	    T->nxt	= settr(649,2,75,0,0,"IF", 1, 3, 0);
		/* /tmp/pt/out/carpet_loom.loom.pml:582 */
	trans[1][72]	= settr(644,2,73,35,0,"(loom_started)", 1, 3, 0);
		tr_2_src(35, "/tmp/pt/out/carpet_loom.loom.pml", 583);
	trans[1][73]	= settr(645,2,74,36,0,"assert(nfull(loom_events))", 1, 3, 0);
		tr_2_src(36, "/tmp/pt/out/carpet_loom.loom.pml", 583);
	trans[1][74]	= settr(646,2,78,37,37,"loom_events!1", 1, 3, 0);
		tr_2_src(37, "/tmp/pt/out/carpet_loom.loom.pml", 583);
	trans[1][78]	= settr(650,2,79,1,0,".(goto)", 1, 3, 0);
	trans[1][75]	= settr(647,2,76,2,0,"else", 1, 3, 0);
	trans[1][76]	= settr(648,2,78,1,0,"(1)", 1, 3, 0);
	trans[1][79]	= settr(651,0,81,1,0,"(1)", 1, 3, 0);
	trans[1][83]	= settr(655,0,84,1,0,"break", 0, 2, 0);
	trans[1][84]	= settr(656,0,0,38,38,"-end-", 0, 3500, 0);
		tr_2_src(38, "/tmp/pt/out/carpet_loom.loom.pml", 589);

	/* proctype 0: machine_loom */

	trans[0] = (Trans **) emalloc(574*sizeof(Trans *));

	T = trans[ 0][572] = settr(571,2,0,0,0,"ATOMIC", 1, 2, 0);
		/* /tmp/pt/out/carpet_loom.loom.pml:33 */
	T->nxt	= settr(571,2,1,0,0,"ATOMIC", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:33 */
	trans[0][1]	= settr(0,2,2,39,39,"loom_r0 = 0", 1, 503, 1003);
		tr_2_src(39, "/tmp/pt/out/carpet_loom.loom.pml", 34);
	trans[0][2]	= settr(1,2,3,40,40,"loom_r1 = 1", 1, 503, 1003);
		tr_2_src(40, "/tmp/pt/out/carpet_loom.loom.pml", 35);
	trans[0][3]	= settr(2,2,4,41,41,"loom_started = 1", 1, 503, 1003);
		tr_2_src(41, "/tmp/pt/out/carpet_loom.loom.pml", 36);
	trans[0][4]	= settr(3,2,9,1,0,"(1)", 1, 503, 1003);
	T = trans[0][9] = settr(8,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:39 */
	T = T->nxt	= settr(8,2,5,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:39 */
	    T->nxt	= settr(8,2,7,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:39 */
	trans[0][5]	= settr(4,2,6,42,0,"((loom_r0==0))", 1, 503, 1003);
		tr_2_src(42, "/tmp/pt/out/carpet_loom.loom.pml", 40);
	trans[0][6]	= settr(5,2,15,1,0,"(1)", 1, 503, 1003);
	trans[0][10]	= settr(9,2,15,1,0,".(goto)", 1, 503, 1003);
	trans[0][7]	= settr(6,2,8,2,0,"else", 1, 503, 1003);
	trans[0][8]	= settr(7,2,15,1,0,"(1)", 1, 503, 1003);
	T = trans[0][15] = settr(14,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:43 */
	T = T->nxt	= settr(14,2,11,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:43 */
	    T->nxt	= settr(14,2,13,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:43 */
	trans[0][11]	= settr(10,2,12,43,0,"((loom_r1==1))", 1, 503, 1003);
		tr_2_src(43, "/tmp/pt/out/carpet_loom.loom.pml", 44);
	trans[0][12]	= settr(11,2,21,1,0,"(1)", 1, 503, 1003);
	trans[0][16]	= settr(15,2,21,1,0,".(goto)", 1, 503, 1003);
	trans[0][13]	= settr(12,2,14,2,0,"else", 1, 503, 1003);
	trans[0][14]	= settr(13,2,21,1,0,"(1)", 1, 503, 1003);
	T = trans[0][21] = settr(20,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:47 */
	T = T->nxt	= settr(20,2,17,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:47 */
	    T->nxt	= settr(20,2,19,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:47 */
	trans[0][17]	= settr(16,2,18,44,0,"((loom_r1==2))", 1, 503, 1003);
		tr_2_src(44, "/tmp/pt/out/carpet_loom.loom.pml", 48);
	trans[0][18]	= settr(17,2,27,1,0,"(1)", 1, 503, 1003);
	trans[0][22]	= settr(21,2,27,1,0,".(goto)", 1, 503, 1003);
	trans[0][19]	= settr(18,2,20,2,0,"else", 1, 503, 1003);
	trans[0][20]	= settr(19,2,27,1,0,"(1)", 1, 503, 1003);
	T = trans[0][27] = settr(26,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:51 */
	T = T->nxt	= settr(26,2,23,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:51 */
	    T->nxt	= settr(26,2,25,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:51 */
	trans[0][23]	= settr(22,2,24,45,0,"((loom_r1==3))", 1, 503, 1003);
		tr_2_src(45, "/tmp/pt/out/carpet_loom.loom.pml", 52);
	trans[0][24]	= settr(23,2,33,1,0,"(1)", 1, 503, 1003);
	trans[0][28]	= settr(27,2,33,1,0,".(goto)", 1, 503, 1003);
	trans[0][25]	= settr(24,2,26,2,0,"else", 1, 503, 1003);
	trans[0][26]	= settr(25,2,33,1,0,"(1)", 1, 503, 1003);
	T = trans[0][33] = settr(32,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:55 */
	T = T->nxt	= settr(32,2,29,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:55 */
	    T->nxt	= settr(32,2,31,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:55 */
	trans[0][29]	= settr(28,2,30,46,0,"((loom_r2==4))", 1, 503, 1003);
		tr_2_src(46, "/tmp/pt/out/carpet_loom.loom.pml", 56);
	trans[0][30]	= settr(29,2,39,1,0,"(1)", 1, 503, 1003);
	trans[0][34]	= settr(33,2,39,1,0,".(goto)", 1, 503, 1003);
	trans[0][31]	= settr(30,2,32,2,0,"else", 1, 503, 1003);
	trans[0][32]	= settr(31,2,39,1,0,"(1)", 1, 503, 1003);
	T = trans[0][39] = settr(38,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:59 */
	T = T->nxt	= settr(38,2,35,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:59 */
	    T->nxt	= settr(38,2,37,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:59 */
	trans[0][35]	= settr(34,2,36,47,0,"((loom_r2==5))", 1, 503, 1003);
		tr_2_src(47, "/tmp/pt/out/carpet_loom.loom.pml", 60);
	trans[0][36]	= settr(35,2,45,1,0,"(1)", 1, 503, 1003);
	trans[0][40]	= settr(39,2,45,1,0,".(goto)", 1, 503, 1003);
	trans[0][37]	= settr(36,2,38,2,0,"else", 1, 503, 1003);
	trans[0][38]	= settr(37,2,45,1,0,"(1)", 1, 503, 1003);
	T = trans[0][45] = settr(44,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:63 */
	T = T->nxt	= settr(44,2,41,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:63 */
	    T->nxt	= settr(44,2,43,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:63 */
	trans[0][41]	= settr(40,2,42,48,0,"((loom_r1==6))", 1, 503, 1003);
		tr_2_src(48, "/tmp/pt/out/carpet_loom.loom.pml", 64);
	trans[0][42]	= settr(41,2,51,1,0,"(1)", 1, 503, 1003);
	trans[0][46]	= settr(45,2,51,1,0,".(goto)", 1, 503, 1003);
	trans[0][43]	= settr(42,2,44,2,0,"else", 1, 503, 1003);
	trans[0][44]	= settr(43,2,51,1,0,"(1)", 1, 503, 1003);
	T = trans[0][51] = settr(50,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:67 */
	T = T->nxt	= settr(50,2,47,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:67 */
	    T->nxt	= settr(50,2,49,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:67 */
	trans[0][47]	= settr(46,2,48,49,0,"((loom_r1==7))", 1, 503, 1003);
		tr_2_src(49, "/tmp/pt/out/carpet_loom.loom.pml", 68);
	trans[0][48]	= settr(47,2,57,1,0,"(1)", 1, 503, 1003);
	trans[0][52]	= settr(51,2,57,1,0,".(goto)", 1, 503, 1003);
	trans[0][49]	= settr(48,2,50,2,0,"else", 1, 503, 1003);
	trans[0][50]	= settr(49,2,57,1,0,"(1)", 1, 503, 1003);
	T = trans[0][57] = settr(56,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:71 */
	T = T->nxt	= settr(56,2,53,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:71 */
	    T->nxt	= settr(56,2,55,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:71 */
	trans[0][53]	= settr(52,2,54,50,0,"((loom_r0==8))", 1, 503, 1003);
		tr_2_src(50, "/tmp/pt/out/carpet_loom.loom.pml", 72);
	trans[0][54]	= settr(53,2,63,1,0,"(1)", 1, 503, 1003);
	trans[0][58]	= settr(57,2,63,1,0,".(goto)", 1, 503, 1003);
	trans[0][55]	= settr(54,2,56,2,0,"else", 1, 503, 1003);
	trans[0][56]	= settr(55,2,63,1,0,"(1)", 1, 503, 1003);
	T = trans[0][63] = settr(62,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:75 */
	T = T->nxt	= settr(62,2,59,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:75 */
	    T->nxt	= settr(62,2,61,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:75 */
	trans[0][59]	= settr(58,2,60,51,0,"((loom_r0==9))", 1, 503, 1003);
		tr_2_src(51, "/tmp/pt/out/carpet_loom.loom.pml", 76);
	trans[0][60]	= settr(59,2,69,1,0,"(1)", 1, 503, 1003);
	trans[0][64]	= settr(63,2,69,1,0,".(goto)", 1, 503, 1003);
	trans[0][61]	= settr(60,2,62,2,0,"else", 1, 503, 1003);
	trans[0][62]	= settr(61,2,69,1,0,"(1)", 1, 503, 1003);
	T = trans[0][69] = settr(68,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:79 */
	T = T->nxt	= settr(68,2,65,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:79 */
	    T->nxt	= settr(68,2,67,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:79 */
	trans[0][65]	= settr(64,2,66,52,0,"((loom_r0==10))", 1, 503, 1003);
		tr_2_src(52, "/tmp/pt/out/carpet_loom.loom.pml", 80);
	trans[0][66]	= settr(65,2,512,1,0,"(1)", 1, 503, 1003);
	trans[0][70]	= settr(69,2,512,1,0,".(goto)", 1, 503, 1003);
	trans[0][67]	= settr(66,2,68,2,0,"else", 1, 503, 1003);
	trans[0][68]	= settr(67,2,512,1,0,"(1)", 1, 503, 1003);
	T = trans[0][512] = settr(511,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:84 */
	T = T->nxt	= settr(511,2,71,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:84 */
	T = T->nxt	= settr(511,2,81,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:84 */
	T = T->nxt	= settr(511,2,91,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:84 */
	T = T->nxt	= settr(511,2,95,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:84 */
	T = T->nxt	= settr(511,2,111,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:84 */
	T = T->nxt	= settr(511,2,127,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:84 */
	T = T->nxt	= settr(511,2,143,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:84 */
	T = T->nxt	= settr(511,2,159,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:84 */
	T = T->nxt	= settr(511,2,175,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:84 */
	T = T->nxt	= settr(511,2,191,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:84 */
	T = T->nxt	= settr(511,2,207,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:84 */
	T = T->nxt	= settr(511,2,223,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:84 */
	T = T->nxt	= settr(511,2,239,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:84 */
	T = T->nxt	= settr(511,2,255,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:84 */
	T = T->nxt	= settr(511,2,271,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:84 */
	T = T->nxt	= settr(511,2,292,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:84 */
	T = T->nxt	= settr(511,2,310,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:84 */
	T = T->nxt	= settr(511,2,328,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:84 */
	T = T->nxt	= settr(511,2,346,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:84 */
	T = T->nxt	= settr(511,2,394,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:84 */
	T = T->nxt	= settr(511,2,460,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:84 */
	T = T->nxt	= settr(511,2,484,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:84 */
	T = T->nxt	= settr(511,2,508,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:84 */
	    T->nxt	= settr(511,2,510,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:84 */
	trans[0][71]	= settr(70,2,76,53,0,"((loom_r1==1))", 1, 503, 1003);
		tr_2_src(53, "/tmp/pt/out/carpet_loom.loom.pml", 85);
	T = trans[0][76] = settr(75,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:86 */
	T = T->nxt	= settr(75,2,72,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:86 */
	    T->nxt	= settr(75,2,74,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:86 */
	trans[0][72]	= settr(71,2,73,54,0,"((loom_r1==3))", 1, 503, 1003);
		tr_2_src(54, "/tmp/pt/out/carpet_loom.loom.pml", 87);
	trans[0][73]	= settr(72,2,78,55,55,"loom_r2 = 255", 1, 503, 1003);
		tr_2_src(55, "/tmp/pt/out/carpet_loom.loom.pml", 88);
	trans[0][77]	= settr(76,2,78,1,0,".(goto)", 1, 503, 1003);
	trans[0][74]	= settr(73,2,75,2,0,"else", 1, 503, 1003);
	trans[0][75]	= settr(74,2,78,1,0,"(1)", 1, 503, 1003);
	trans[0][78]	= settr(77,2,79,56,56,"loom_r1 = 255", 1, 503, 1003);
		tr_2_src(56, "/tmp/pt/out/carpet_loom.loom.pml", 91);
	trans[0][79]	= settr(78,2,80,57,57,"loom_r1 = 2", 1, 503, 1003);
		tr_2_src(57, "/tmp/pt/out/carpet_loom.loom.pml", 92);
	trans[0][80]	= settr(79,2,9,1,0,"(1)", 1, 503, 1003);
	trans[0][513]	= settr(512,2,9,1,0,".(goto)", 1, 503, 1003);
	trans[0][81]	= settr(80,2,86,58,0,"((loom_r1==2))", 1, 503, 1003);
		tr_2_src(58, "/tmp/pt/out/carpet_loom.loom.pml", 94);
	T = trans[0][86] = settr(85,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:95 */
	T = T->nxt	= settr(85,2,82,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:95 */
	    T->nxt	= settr(85,2,84,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:95 */
	trans[0][82]	= settr(81,2,83,59,0,"((loom_r1==3))", 1, 503, 1003);
		tr_2_src(59, "/tmp/pt/out/carpet_loom.loom.pml", 96);
	trans[0][83]	= settr(82,2,88,60,60,"loom_r2 = 255", 1, 503, 1003);
		tr_2_src(60, "/tmp/pt/out/carpet_loom.loom.pml", 97);
	trans[0][87]	= settr(86,2,88,1,0,".(goto)", 1, 503, 1003);
	trans[0][84]	= settr(83,2,85,2,0,"else", 1, 503, 1003);
	trans[0][85]	= settr(84,2,88,1,0,"(1)", 1, 503, 1003);
	trans[0][88]	= settr(87,2,89,61,61,"loom_r1 = 255", 1, 503, 1003);
		tr_2_src(61, "/tmp/pt/out/carpet_loom.loom.pml", 100);
	trans[0][89]	= settr(88,2,90,62,62,"loom_r1 = 1", 1, 503, 1003);
		tr_2_src(62, "/tmp/pt/out/carpet_loom.loom.pml", 101);
	trans[0][90]	= settr(89,2,9,1,0,"(1)", 1, 503, 1003);
	trans[0][91]	= settr(90,2,92,63,0,"((loom_r2==4))", 1, 503, 1003);
		tr_2_src(63, "/tmp/pt/out/carpet_loom.loom.pml", 103);
	trans[0][92]	= settr(91,2,93,64,64,"loom_r2 = 255", 1, 503, 1003);
		tr_2_src(64, "/tmp/pt/out/carpet_loom.loom.pml", 104);
	trans[0][93]	= settr(92,2,94,65,65,"loom_r2 = 5", 1, 503, 1003);
		tr_2_src(65, "/tmp/pt/out/carpet_loom.loom.pml", 105);
	trans[0][94]	= settr(93,2,9,1,0,"(1)", 1, 503, 1003);
	trans[0][95]	= settr(94,2,106,66,0,"((loom_r2==4))", 1, 503, 1003);
		tr_2_src(66, "/tmp/pt/out/carpet_loom.loom.pml", 107);
	T = trans[0][106] = settr(105,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:108 */
	T = T->nxt	= settr(105,2,96,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:108 */
	    T->nxt	= settr(105,2,104,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:108 */
	trans[0][96]	= settr(95,2,101,67,0,"((loom_r0==0))", 1, 503, 1003);
		tr_2_src(67, "/tmp/pt/out/carpet_loom.loom.pml", 109);
	T = trans[0][101] = settr(100,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:110 */
	T = T->nxt	= settr(100,2,97,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:110 */
	    T->nxt	= settr(100,2,99,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:110 */
	trans[0][97]	= settr(96,2,98,68,0,"((loom_r1==3))", 1, 503, 1003);
		tr_2_src(68, "/tmp/pt/out/carpet_loom.loom.pml", 111);
	trans[0][98]	= settr(97,2,103,69,69,"loom_r2 = 255", 1, 503, 1003);
		tr_2_src(69, "/tmp/pt/out/carpet_loom.loom.pml", 112);
	trans[0][102]	= settr(101,2,103,1,0,".(goto)", 1, 503, 1003);
	trans[0][99]	= settr(98,2,100,2,0,"else", 1, 503, 1003);
	trans[0][100]	= settr(99,2,103,1,0,"(1)", 1, 503, 1003);
	trans[0][103]	= settr(102,2,108,70,70,"loom_r1 = 255", 1, 503, 1003);
		tr_2_src(70, "/tmp/pt/out/carpet_loom.loom.pml", 115);
	trans[0][107]	= settr(106,2,108,1,0,".(goto)", 1, 503, 1003);
	trans[0][104]	= settr(103,2,105,2,0,"else", 1, 503, 1003);
	trans[0][105]	= settr(104,2,108,1,0,"(1)", 1, 503, 1003);
	trans[0][108]	= settr(107,2,109,71,71,"loom_r0 = 255", 1, 503, 1003);
		tr_2_src(71, "/tmp/pt/out/carpet_loom.loom.pml", 118);
	trans[0][109]	= settr(108,2,110,72,72,"loom_r0 = 9", 1, 503, 1003);
		tr_2_src(72, "/tmp/pt/out/carpet_loom.loom.pml", 119);
	trans[0][110]	= settr(109,2,9,1,0,"(1)", 1, 503, 1003);
	trans[0][111]	= settr(110,2,122,73,0,"((loom_r1==3))", 1, 503, 1003);
		tr_2_src(73, "/tmp/pt/out/carpet_loom.loom.pml", 121);
	T = trans[0][122] = settr(121,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:122 */
	T = T->nxt	= settr(121,2,112,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:122 */
	    T->nxt	= settr(121,2,120,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:122 */
	trans[0][112]	= settr(111,2,117,74,0,"((loom_r0==0))", 1, 503, 1003);
		tr_2_src(74, "/tmp/pt/out/carpet_loom.loom.pml", 123);
	T = trans[0][117] = settr(116,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:124 */
	T = T->nxt	= settr(116,2,113,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:124 */
	    T->nxt	= settr(116,2,115,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:124 */
	trans[0][113]	= settr(112,2,114,75,0,"((loom_r1==3))", 1, 503, 1003);
		tr_2_src(75, "/tmp/pt/out/carpet_loom.loom.pml", 125);
	trans[0][114]	= settr(113,2,119,76,76,"loom_r2 = 255", 1, 503, 1003);
		tr_2_src(76, "/tmp/pt/out/carpet_loom.loom.pml", 126);
	trans[0][118]	= settr(117,2,119,1,0,".(goto)", 1, 503, 1003);
	trans[0][115]	= settr(114,2,116,2,0,"else", 1, 503, 1003);
	trans[0][116]	= settr(115,2,119,1,0,"(1)", 1, 503, 1003);
	trans[0][119]	= settr(118,2,124,77,77,"loom_r1 = 255", 1, 503, 1003);
		tr_2_src(77, "/tmp/pt/out/carpet_loom.loom.pml", 129);
	trans[0][123]	= settr(122,2,124,1,0,".(goto)", 1, 503, 1003);
	trans[0][120]	= settr(119,2,121,2,0,"else", 1, 503, 1003);
	trans[0][121]	= settr(120,2,124,1,0,"(1)", 1, 503, 1003);
	trans[0][124]	= settr(123,2,125,78,78,"loom_r0 = 255", 1, 503, 1003);
		tr_2_src(78, "/tmp/pt/out/carpet_loom.loom.pml", 132);
	trans[0][125]	= settr(124,2,126,79,79,"loom_r0 = 9", 1, 503, 1003);
		tr_2_src(79, "/tmp/pt/out/carpet_loom.loom.pml", 133);
	trans[0][126]	= settr(125,2,9,1,0,"(1)", 1, 503, 1003);
	trans[0][127]	= settr(126,2,138,80,0,"((loom_r1==3))", 1, 503, 1003);
		tr_2_src(80, "/tmp/pt/out/carpet_loom.loom.pml", 135);
	T = trans[0][138] = settr(137,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:136 */
	T = T->nxt	= settr(137,2,128,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:136 */
	    T->nxt	= settr(137,2,136,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:136 */
	trans[0][128]	= settr(127,2,133,81,0,"((loom_r0==0))", 1, 503, 1003);
		tr_2_src(81, "/tmp/pt/out/carpet_loom.loom.pml", 137);
	T = trans[0][133] = settr(132,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:138 */
	T = T->nxt	= settr(132,2,129,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:138 */
	    T->nxt	= settr(132,2,131,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:138 */
	trans[0][129]	= settr(128,2,130,82,0,"((loom_r1==3))", 1, 503, 1003);
		tr_2_src(82, "/tmp/pt/out/carpet_loom.loom.pml", 139);
	trans[0][130]	= settr(129,2,135,83,83,"loom_r2 = 255", 1, 503, 1003);
		tr_2_src(83, "/tmp/pt/out/carpet_loom.loom.pml", 140);
	trans[0][134]	= settr(133,2,135,1,0,".(goto)", 1, 503, 1003);
	trans[0][131]	= settr(130,2,132,2,0,"else", 1, 503, 1003);
	trans[0][132]	= settr(131,2,135,1,0,"(1)", 1, 503, 1003);
	trans[0][135]	= settr(134,2,140,84,84,"loom_r1 = 255", 1, 503, 1003);
		tr_2_src(84, "/tmp/pt/out/carpet_loom.loom.pml", 143);
	trans[0][139]	= settr(138,2,140,1,0,".(goto)", 1, 503, 1003);
	trans[0][136]	= settr(135,2,137,2,0,"else", 1, 503, 1003);
	trans[0][137]	= settr(136,2,140,1,0,"(1)", 1, 503, 1003);
	trans[0][140]	= settr(139,2,141,85,85,"loom_r0 = 255", 1, 503, 1003);
		tr_2_src(85, "/tmp/pt/out/carpet_loom.loom.pml", 146);
	trans[0][141]	= settr(140,2,142,86,86,"loom_r0 = 9", 1, 503, 1003);
		tr_2_src(86, "/tmp/pt/out/carpet_loom.loom.pml", 147);
	trans[0][142]	= settr(141,2,9,1,0,"(1)", 1, 503, 1003);
	trans[0][143]	= settr(142,2,154,87,0,"((loom_r1==3))", 1, 503, 1003);
		tr_2_src(87, "/tmp/pt/out/carpet_loom.loom.pml", 149);
	T = trans[0][154] = settr(153,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:150 */
	T = T->nxt	= settr(153,2,144,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:150 */
	    T->nxt	= settr(153,2,152,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:150 */
	trans[0][144]	= settr(143,2,149,88,0,"((loom_r0==0))", 1, 503, 1003);
		tr_2_src(88, "/tmp/pt/out/carpet_loom.loom.pml", 151);
	T = trans[0][149] = settr(148,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:152 */
	T = T->nxt	= settr(148,2,145,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:152 */
	    T->nxt	= settr(148,2,147,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:152 */
	trans[0][145]	= settr(144,2,146,89,0,"((loom_r1==3))", 1, 503, 1003);
		tr_2_src(89, "/tmp/pt/out/carpet_loom.loom.pml", 153);
	trans[0][146]	= settr(145,2,151,90,90,"loom_r2 = 255", 1, 503, 1003);
		tr_2_src(90, "/tmp/pt/out/carpet_loom.loom.pml", 154);
	trans[0][150]	= settr(149,2,151,1,0,".(goto)", 1, 503, 1003);
	trans[0][147]	= settr(146,2,148,2,0,"else", 1, 503, 1003);
	trans[0][148]	= settr(147,2,151,1,0,"(1)", 1, 503, 1003);
	trans[0][151]	= settr(150,2,156,91,91,"loom_r1 = 255", 1, 503, 1003);
		tr_2_src(91, "/tmp/pt/out/carpet_loom.loom.pml", 157);
	trans[0][155]	= settr(154,2,156,1,0,".(goto)", 1, 503, 1003);
	trans[0][152]	= settr(151,2,153,2,0,"else", 1, 503, 1003);
	trans[0][153]	= settr(152,2,156,1,0,"(1)", 1, 503, 1003);
	trans[0][156]	= settr(155,2,157,92,92,"loom_r0 = 255", 1, 503, 1003);
		tr_2_src(92, "/tmp/pt/out/carpet_loom.loom.pml", 160);
	trans[0][157]	= settr(156,2,158,93,93,"loom_r0 = 9", 1, 503, 1003);
		tr_2_src(93, "/tmp/pt/out/carpet_loom.loom.pml", 161);
	trans[0][158]	= settr(157,2,9,1,0,"(1)", 1, 503, 1003);
	trans[0][159]	= settr(158,2,170,94,0,"((loom_r2==5))", 1, 503, 1003);
		tr_2_src(94, "/tmp/pt/out/carpet_loom.loom.pml", 163);
	T = trans[0][170] = settr(169,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:164 */
	T = T->nxt	= settr(169,2,160,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:164 */
	    T->nxt	= settr(169,2,168,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:164 */
	trans[0][160]	= settr(159,2,165,95,0,"((loom_r0==0))", 1, 503, 1003);
		tr_2_src(95, "/tmp/pt/out/carpet_loom.loom.pml", 165);
	T = trans[0][165] = settr(164,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:166 */
	T = T->nxt	= settr(164,2,161,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:166 */
	    T->nxt	= settr(164,2,163,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:166 */
	trans[0][161]	= settr(160,2,162,96,0,"((loom_r1==3))", 1, 503, 1003);
		tr_2_src(96, "/tmp/pt/out/carpet_loom.loom.pml", 167);
	trans[0][162]	= settr(161,2,167,97,97,"loom_r2 = 255", 1, 503, 1003);
		tr_2_src(97, "/tmp/pt/out/carpet_loom.loom.pml", 168);
	trans[0][166]	= settr(165,2,167,1,0,".(goto)", 1, 503, 1003);
	trans[0][163]	= settr(162,2,164,2,0,"else", 1, 503, 1003);
	trans[0][164]	= settr(163,2,167,1,0,"(1)", 1, 503, 1003);
	trans[0][167]	= settr(166,2,172,98,98,"loom_r1 = 255", 1, 503, 1003);
		tr_2_src(98, "/tmp/pt/out/carpet_loom.loom.pml", 171);
	trans[0][171]	= settr(170,2,172,1,0,".(goto)", 1, 503, 1003);
	trans[0][168]	= settr(167,2,169,2,0,"else", 1, 503, 1003);
	trans[0][169]	= settr(168,2,172,1,0,"(1)", 1, 503, 1003);
	trans[0][172]	= settr(171,2,173,99,99,"loom_r0 = 255", 1, 503, 1003);
		tr_2_src(99, "/tmp/pt/out/carpet_loom.loom.pml", 174);
	trans[0][173]	= settr(172,2,174,100,100,"loom_r0 = 9", 1, 503, 1003);
		tr_2_src(100, "/tmp/pt/out/carpet_loom.loom.pml", 175);
	trans[0][174]	= settr(173,2,9,1,0,"(1)", 1, 503, 1003);
	trans[0][175]	= settr(174,2,186,101,0,"((loom_r1==6))", 1, 503, 1003);
		tr_2_src(101, "/tmp/pt/out/carpet_loom.loom.pml", 177);
	T = trans[0][186] = settr(185,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:178 */
	T = T->nxt	= settr(185,2,176,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:178 */
	    T->nxt	= settr(185,2,184,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:178 */
	trans[0][176]	= settr(175,2,181,102,0,"((loom_r0==0))", 1, 503, 1003);
		tr_2_src(102, "/tmp/pt/out/carpet_loom.loom.pml", 179);
	T = trans[0][181] = settr(180,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:180 */
	T = T->nxt	= settr(180,2,177,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:180 */
	    T->nxt	= settr(180,2,179,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:180 */
	trans[0][177]	= settr(176,2,178,103,0,"((loom_r1==3))", 1, 503, 1003);
		tr_2_src(103, "/tmp/pt/out/carpet_loom.loom.pml", 181);
	trans[0][178]	= settr(177,2,183,104,104,"loom_r2 = 255", 1, 503, 1003);
		tr_2_src(104, "/tmp/pt/out/carpet_loom.loom.pml", 182);
	trans[0][182]	= settr(181,2,183,1,0,".(goto)", 1, 503, 1003);
	trans[0][179]	= settr(178,2,180,2,0,"else", 1, 503, 1003);
	trans[0][180]	= settr(179,2,183,1,0,"(1)", 1, 503, 1003);
	trans[0][183]	= settr(182,2,188,105,105,"loom_r1 = 255", 1, 503, 1003);
		tr_2_src(105, "/tmp/pt/out/carpet_loom.loom.pml", 185);
	trans[0][187]	= settr(186,2,188,1,0,".(goto)", 1, 503, 1003);
	trans[0][184]	= settr(183,2,185,2,0,"else", 1, 503, 1003);
	trans[0][185]	= settr(184,2,188,1,0,"(1)", 1, 503, 1003);
	trans[0][188]	= settr(187,2,189,106,106,"loom_r0 = 255", 1, 503, 1003);
		tr_2_src(106, "/tmp/pt/out/carpet_loom.loom.pml", 188);
	trans[0][189]	= settr(188,2,190,107,107,"loom_r0 = 9", 1, 503, 1003);
		tr_2_src(107, "/tmp/pt/out/carpet_loom.loom.pml", 189);
	trans[0][190]	= settr(189,2,9,1,0,"(1)", 1, 503, 1003);
	trans[0][191]	= settr(190,2,202,108,0,"((loom_r1==6))", 1, 503, 1003);
		tr_2_src(108, "/tmp/pt/out/carpet_loom.loom.pml", 191);
	T = trans[0][202] = settr(201,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:192 */
	T = T->nxt	= settr(201,2,192,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:192 */
	    T->nxt	= settr(201,2,200,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:192 */
	trans[0][192]	= settr(191,2,197,109,0,"((loom_r0==0))", 1, 503, 1003);
		tr_2_src(109, "/tmp/pt/out/carpet_loom.loom.pml", 193);
	T = trans[0][197] = settr(196,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:194 */
	T = T->nxt	= settr(196,2,193,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:194 */
	    T->nxt	= settr(196,2,195,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:194 */
	trans[0][193]	= settr(192,2,194,110,0,"((loom_r1==3))", 1, 503, 1003);
		tr_2_src(110, "/tmp/pt/out/carpet_loom.loom.pml", 195);
	trans[0][194]	= settr(193,2,199,111,111,"loom_r2 = 255", 1, 503, 1003);
		tr_2_src(111, "/tmp/pt/out/carpet_loom.loom.pml", 196);
	trans[0][198]	= settr(197,2,199,1,0,".(goto)", 1, 503, 1003);
	trans[0][195]	= settr(194,2,196,2,0,"else", 1, 503, 1003);
	trans[0][196]	= settr(195,2,199,1,0,"(1)", 1, 503, 1003);
	trans[0][199]	= settr(198,2,204,112,112,"loom_r1 = 255", 1, 503, 1003);
		tr_2_src(112, "/tmp/pt/out/carpet_loom.loom.pml", 199);
	trans[0][203]	= settr(202,2,204,1,0,".(goto)", 1, 503, 1003);
	trans[0][200]	= settr(199,2,201,2,0,"else", 1, 503, 1003);
	trans[0][201]	= settr(200,2,204,1,0,"(1)", 1, 503, 1003);
	trans[0][204]	= settr(203,2,205,113,113,"loom_r0 = 255", 1, 503, 1003);
		tr_2_src(113, "/tmp/pt/out/carpet_loom.loom.pml", 202);
	trans[0][205]	= settr(204,2,206,114,114,"loom_r0 = 9", 1, 503, 1003);
		tr_2_src(114, "/tmp/pt/out/carpet_loom.loom.pml", 203);
	trans[0][206]	= settr(205,2,9,1,0,"(1)", 1, 503, 1003);
	trans[0][207]	= settr(206,2,218,115,0,"((loom_r1==6))", 1, 503, 1003);
		tr_2_src(115, "/tmp/pt/out/carpet_loom.loom.pml", 205);
	T = trans[0][218] = settr(217,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:206 */
	T = T->nxt	= settr(217,2,208,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:206 */
	    T->nxt	= settr(217,2,216,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:206 */
	trans[0][208]	= settr(207,2,213,116,0,"((loom_r0==0))", 1, 503, 1003);
		tr_2_src(116, "/tmp/pt/out/carpet_loom.loom.pml", 207);
	T = trans[0][213] = settr(212,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:208 */
	T = T->nxt	= settr(212,2,209,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:208 */
	    T->nxt	= settr(212,2,211,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:208 */
	trans[0][209]	= settr(208,2,210,117,0,"((loom_r1==3))", 1, 503, 1003);
		tr_2_src(117, "/tmp/pt/out/carpet_loom.loom.pml", 209);
	trans[0][210]	= settr(209,2,215,118,118,"loom_r2 = 255", 1, 503, 1003);
		tr_2_src(118, "/tmp/pt/out/carpet_loom.loom.pml", 210);
	trans[0][214]	= settr(213,2,215,1,0,".(goto)", 1, 503, 1003);
	trans[0][211]	= settr(210,2,212,2,0,"else", 1, 503, 1003);
	trans[0][212]	= settr(211,2,215,1,0,"(1)", 1, 503, 1003);
	trans[0][215]	= settr(214,2,220,119,119,"loom_r1 = 255", 1, 503, 1003);
		tr_2_src(119, "/tmp/pt/out/carpet_loom.loom.pml", 213);
	trans[0][219]	= settr(218,2,220,1,0,".(goto)", 1, 503, 1003);
	trans[0][216]	= settr(215,2,217,2,0,"else", 1, 503, 1003);
	trans[0][217]	= settr(216,2,220,1,0,"(1)", 1, 503, 1003);
	trans[0][220]	= settr(219,2,221,120,120,"loom_r0 = 255", 1, 503, 1003);
		tr_2_src(120, "/tmp/pt/out/carpet_loom.loom.pml", 216);
	trans[0][221]	= settr(220,2,222,121,121,"loom_r0 = 9", 1, 503, 1003);
		tr_2_src(121, "/tmp/pt/out/carpet_loom.loom.pml", 217);
	trans[0][222]	= settr(221,2,9,1,0,"(1)", 1, 503, 1003);
	trans[0][223]	= settr(222,2,234,122,0,"((loom_r0==0))", 1, 503, 1003);
		tr_2_src(122, "/tmp/pt/out/carpet_loom.loom.pml", 219);
	T = trans[0][234] = settr(233,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:220 */
	T = T->nxt	= settr(233,2,224,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:220 */
	    T->nxt	= settr(233,2,232,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:220 */
	trans[0][224]	= settr(223,2,229,123,0,"((loom_r0==0))", 1, 503, 1003);
		tr_2_src(123, "/tmp/pt/out/carpet_loom.loom.pml", 221);
	T = trans[0][229] = settr(228,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:222 */
	T = T->nxt	= settr(228,2,225,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:222 */
	    T->nxt	= settr(228,2,227,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:222 */
	trans[0][225]	= settr(224,2,226,124,0,"((loom_r1==3))", 1, 503, 1003);
		tr_2_src(124, "/tmp/pt/out/carpet_loom.loom.pml", 223);
	trans[0][226]	= settr(225,2,231,125,125,"loom_r2 = 255", 1, 503, 1003);
		tr_2_src(125, "/tmp/pt/out/carpet_loom.loom.pml", 224);
	trans[0][230]	= settr(229,2,231,1,0,".(goto)", 1, 503, 1003);
	trans[0][227]	= settr(226,2,228,2,0,"else", 1, 503, 1003);
	trans[0][228]	= settr(227,2,231,1,0,"(1)", 1, 503, 1003);
	trans[0][231]	= settr(230,2,236,126,126,"loom_r1 = 255", 1, 503, 1003);
		tr_2_src(126, "/tmp/pt/out/carpet_loom.loom.pml", 227);
	trans[0][235]	= settr(234,2,236,1,0,".(goto)", 1, 503, 1003);
	trans[0][232]	= settr(231,2,233,2,0,"else", 1, 503, 1003);
	trans[0][233]	= settr(232,2,236,1,0,"(1)", 1, 503, 1003);
	trans[0][236]	= settr(235,2,237,127,127,"loom_r0 = 255", 1, 503, 1003);
		tr_2_src(127, "/tmp/pt/out/carpet_loom.loom.pml", 230);
	trans[0][237]	= settr(236,2,238,128,128,"loom_r0 = 8", 1, 503, 1003);
		tr_2_src(128, "/tmp/pt/out/carpet_loom.loom.pml", 231);
	trans[0][238]	= settr(237,2,9,1,0,"(1)", 1, 503, 1003);
	trans[0][239]	= settr(238,2,250,129,0,"((loom_r0==0))", 1, 503, 1003);
		tr_2_src(129, "/tmp/pt/out/carpet_loom.loom.pml", 233);
	T = trans[0][250] = settr(249,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:234 */
	T = T->nxt	= settr(249,2,240,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:234 */
	    T->nxt	= settr(249,2,248,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:234 */
	trans[0][240]	= settr(239,2,245,130,0,"((loom_r0==0))", 1, 503, 1003);
		tr_2_src(130, "/tmp/pt/out/carpet_loom.loom.pml", 235);
	T = trans[0][245] = settr(244,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:236 */
	T = T->nxt	= settr(244,2,241,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:236 */
	    T->nxt	= settr(244,2,243,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:236 */
	trans[0][241]	= settr(240,2,242,131,0,"((loom_r1==3))", 1, 503, 1003);
		tr_2_src(131, "/tmp/pt/out/carpet_loom.loom.pml", 237);
	trans[0][242]	= settr(241,2,247,132,132,"loom_r2 = 255", 1, 503, 1003);
		tr_2_src(132, "/tmp/pt/out/carpet_loom.loom.pml", 238);
	trans[0][246]	= settr(245,2,247,1,0,".(goto)", 1, 503, 1003);
	trans[0][243]	= settr(242,2,244,2,0,"else", 1, 503, 1003);
	trans[0][244]	= settr(243,2,247,1,0,"(1)", 1, 503, 1003);
	trans[0][247]	= settr(246,2,252,133,133,"loom_r1 = 255", 1, 503, 1003);
		tr_2_src(133, "/tmp/pt/out/carpet_loom.loom.pml", 241);
	trans[0][251]	= settr(250,2,252,1,0,".(goto)", 1, 503, 1003);
	trans[0][248]	= settr(247,2,249,2,0,"else", 1, 503, 1003);
	trans[0][249]	= settr(248,2,252,1,0,"(1)", 1, 503, 1003);
	trans[0][252]	= settr(251,2,253,134,134,"loom_r0 = 255", 1, 503, 1003);
		tr_2_src(134, "/tmp/pt/out/carpet_loom.loom.pml", 244);
	trans[0][253]	= settr(252,2,254,135,135,"loom_r0 = 9", 1, 503, 1003);
		tr_2_src(135, "/tmp/pt/out/carpet_loom.loom.pml", 245);
	trans[0][254]	= settr(253,2,9,1,0,"(1)", 1, 503, 1003);
	trans[0][255]	= settr(254,2,266,136,0,"((loom_r1==3))", 1, 503, 1003);
		tr_2_src(136, "/tmp/pt/out/carpet_loom.loom.pml", 247);
	T = trans[0][266] = settr(265,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:248 */
	T = T->nxt	= settr(265,2,256,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:248 */
	    T->nxt	= settr(265,2,264,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:248 */
	trans[0][256]	= settr(255,2,261,137,0,"((loom_r0==0))", 1, 503, 1003);
		tr_2_src(137, "/tmp/pt/out/carpet_loom.loom.pml", 249);
	T = trans[0][261] = settr(260,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:250 */
	T = T->nxt	= settr(260,2,257,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:250 */
	    T->nxt	= settr(260,2,259,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:250 */
	trans[0][257]	= settr(256,2,258,138,0,"((loom_r1==3))", 1, 503, 1003);
		tr_2_src(138, "/tmp/pt/out/carpet_loom.loom.pml", 251);
	trans[0][258]	= settr(257,2,263,139,139,"loom_r2 = 255", 1, 503, 1003);
		tr_2_src(139, "/tmp/pt/out/carpet_loom.loom.pml", 252);
	trans[0][262]	= settr(261,2,263,1,0,".(goto)", 1, 503, 1003);
	trans[0][259]	= settr(258,2,260,2,0,"else", 1, 503, 1003);
	trans[0][260]	= settr(259,2,263,1,0,"(1)", 1, 503, 1003);
	trans[0][263]	= settr(262,2,268,140,140,"loom_r1 = 255", 1, 503, 1003);
		tr_2_src(140, "/tmp/pt/out/carpet_loom.loom.pml", 255);
	trans[0][267]	= settr(266,2,268,1,0,".(goto)", 1, 503, 1003);
	trans[0][264]	= settr(263,2,265,2,0,"else", 1, 503, 1003);
	trans[0][265]	= settr(264,2,268,1,0,"(1)", 1, 503, 1003);
	trans[0][268]	= settr(267,2,269,141,141,"loom_r0 = 255", 1, 503, 1003);
		tr_2_src(141, "/tmp/pt/out/carpet_loom.loom.pml", 258);
	trans[0][269]	= settr(268,2,270,142,142,"loom_r0 = 9", 1, 503, 1003);
		tr_2_src(142, "/tmp/pt/out/carpet_loom.loom.pml", 259);
	trans[0][270]	= settr(269,2,9,1,0,"(1)", 1, 503, 1003);
	trans[0][271]	= settr(270,2,272,143,143,"loom_events?0", 1, 503, 1003);
		tr_2_src(143, "/tmp/pt/out/carpet_loom.loom.pml", 261);
	trans[0][272]	= settr(271,2,288,144,144,"taken = 0", 1, 503, 1003);
		tr_2_src(144, "/tmp/pt/out/carpet_loom.loom.pml", 262);
	T = trans[0][288] = settr(287,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:263 */
	T = T->nxt	= settr(287,2,273,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:263 */
	T = T->nxt	= settr(287,2,284,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:263 */
	    T->nxt	= settr(287,2,286,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:263 */
	trans[0][273]	= settr(272,2,274,145,145,"(((loom_r1==2)&&!(taken)))", 1, 503, 1003);
		tr_2_src(145, "/tmp/pt/out/carpet_loom.loom.pml", 264);
	trans[0][274]	= settr(273,2,279,146,146,"taken = 1", 1, 503, 1003);
		tr_2_src(146, "/tmp/pt/out/carpet_loom.loom.pml", 265);
	T = trans[0][279] = settr(278,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:266 */
	T = T->nxt	= settr(278,2,275,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:266 */
	    T->nxt	= settr(278,2,277,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:266 */
	trans[0][275]	= settr(274,2,276,147,0,"((loom_r1==3))", 1, 503, 1003);
		tr_2_src(147, "/tmp/pt/out/carpet_loom.loom.pml", 267);
	trans[0][276]	= settr(275,2,281,148,148,"loom_r2 = 255", 1, 503, 1003);
		tr_2_src(148, "/tmp/pt/out/carpet_loom.loom.pml", 268);
	trans[0][280]	= settr(279,2,281,1,0,".(goto)", 1, 503, 1003);
	trans[0][277]	= settr(276,2,278,2,0,"else", 1, 503, 1003);
	trans[0][278]	= settr(277,2,281,1,0,"(1)", 1, 503, 1003);
	trans[0][281]	= settr(280,2,282,149,149,"loom_r1 = 255", 1, 503, 1003);
		tr_2_src(149, "/tmp/pt/out/carpet_loom.loom.pml", 271);
	trans[0][282]	= settr(281,2,283,150,150,"loom_r1 = 3", 1, 503, 1003);
		tr_2_src(150, "/tmp/pt/out/carpet_loom.loom.pml", 272);
	trans[0][283]	= settr(282,2,290,151,151,"loom_r2 = 4", 1, 503, 1003);
		tr_2_src(151, "/tmp/pt/out/carpet_loom.loom.pml", 273);
	trans[0][289]	= settr(288,2,290,1,0,".(goto)", 1, 503, 1003);
	trans[0][284]	= settr(283,2,285,152,152,"(((loom_r1==2)&&!(taken)))", 1, 503, 1003);
		tr_2_src(152, "/tmp/pt/out/carpet_loom.loom.pml", 274);
	trans[0][285]	= settr(284,2,290,1,0,"(1)", 1, 503, 1003);
	trans[0][286]	= settr(285,2,287,153,153,"(!(((loom_r1==2)&&!(taken))))", 1, 503, 1003);
		tr_2_src(153, "/tmp/pt/out/carpet_loom.loom.pml", 276);
	trans[0][287]	= settr(286,2,290,1,0,"(1)", 1, 503, 1003);
	trans[0][290]	= settr(289,2,291,1,0,"(1)", 1, 503, 1003);
	trans[0][291]	= settr(290,2,9,154,154,"taken = 0", 1, 503, 1003);
		tr_2_src(154, "/tmp/pt/out/carpet_loom.loom.pml", 279);
	trans[0][292]	= settr(291,2,293,155,155,"loom_events?1", 1, 503, 1003);
		tr_2_src(155, "/tmp/pt/out/carpet_loom.loom.pml", 280);
	trans[0][293]	= settr(292,2,306,156,156,"taken = 0", 1, 503, 1003);
		tr_2_src(156, "/tmp/pt/out/carpet_loom.loom.pml", 281);
	T = trans[0][306] = settr(305,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:282 */
	T = T->nxt	= settr(305,2,294,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:282 */
	    T->nxt	= settr(305,2,304,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:282 */
	trans[0][294]	= settr(293,2,295,157,157,"(((loom_r1==3)&&!(taken)))", 1, 503, 1003);
		tr_2_src(157, "/tmp/pt/out/carpet_loom.loom.pml", 283);
	trans[0][295]	= settr(294,2,300,158,158,"taken = 1", 1, 503, 1003);
		tr_2_src(158, "/tmp/pt/out/carpet_loom.loom.pml", 284);
	T = trans[0][300] = settr(299,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:285 */
	T = T->nxt	= settr(299,2,296,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:285 */
	    T->nxt	= settr(299,2,298,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:285 */
	trans[0][296]	= settr(295,2,297,159,0,"((loom_r1==3))", 1, 503, 1003);
		tr_2_src(159, "/tmp/pt/out/carpet_loom.loom.pml", 286);
	trans[0][297]	= settr(296,2,302,160,160,"loom_r2 = 255", 1, 503, 1003);
		tr_2_src(160, "/tmp/pt/out/carpet_loom.loom.pml", 287);
	trans[0][301]	= settr(300,2,302,1,0,".(goto)", 1, 503, 1003);
	trans[0][298]	= settr(297,2,299,2,0,"else", 1, 503, 1003);
	trans[0][299]	= settr(298,2,302,1,0,"(1)", 1, 503, 1003);
	trans[0][302]	= settr(301,2,303,161,161,"loom_r1 = 255", 1, 503, 1003);
		tr_2_src(161, "/tmp/pt/out/carpet_loom.loom.pml", 290);
	trans[0][303]	= settr(302,2,308,162,162,"loom_r1 = 6", 1, 503, 1003);
		tr_2_src(162, "/tmp/pt/out/carpet_loom.loom.pml", 291);
	trans[0][307]	= settr(306,2,308,1,0,".(goto)", 1, 503, 1003);
	trans[0][304]	= settr(303,2,305,163,163,"(!(((loom_r1==3)&&!(taken))))", 1, 503, 1003);
		tr_2_src(163, "/tmp/pt/out/carpet_loom.loom.pml", 292);
	trans[0][305]	= settr(304,2,308,1,0,"(1)", 1, 503, 1003);
	trans[0][308]	= settr(307,2,309,1,0,"(1)", 1, 503, 1003);
	trans[0][309]	= settr(308,2,9,164,164,"taken = 0", 1, 503, 1003);
		tr_2_src(164, "/tmp/pt/out/carpet_loom.loom.pml", 295);
	trans[0][310]	= settr(309,2,311,165,165,"loom_events?2", 1, 503, 1003);
		tr_2_src(165, "/tmp/pt/out/carpet_loom.loom.pml", 296);
	trans[0][311]	= settr(310,2,324,166,166,"taken = 0", 1, 503, 1003);
		tr_2_src(166, "/tmp/pt/out/carpet_loom.loom.pml", 297);
	T = trans[0][324] = settr(323,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:298 */
	T = T->nxt	= settr(323,2,312,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:298 */
	    T->nxt	= settr(323,2,322,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:298 */
	trans[0][312]	= settr(311,2,313,167,167,"(((loom_r1==3)&&!(taken)))", 1, 503, 1003);
		tr_2_src(167, "/tmp/pt/out/carpet_loom.loom.pml", 299);
	trans[0][313]	= settr(312,2,318,168,168,"taken = 1", 1, 503, 1003);
		tr_2_src(168, "/tmp/pt/out/carpet_loom.loom.pml", 300);
	T = trans[0][318] = settr(317,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:301 */
	T = T->nxt	= settr(317,2,314,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:301 */
	    T->nxt	= settr(317,2,316,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:301 */
	trans[0][314]	= settr(313,2,315,169,0,"((loom_r1==3))", 1, 503, 1003);
		tr_2_src(169, "/tmp/pt/out/carpet_loom.loom.pml", 302);
	trans[0][315]	= settr(314,2,320,170,170,"loom_r2 = 255", 1, 503, 1003);
		tr_2_src(170, "/tmp/pt/out/carpet_loom.loom.pml", 303);
	trans[0][319]	= settr(318,2,320,1,0,".(goto)", 1, 503, 1003);
	trans[0][316]	= settr(315,2,317,2,0,"else", 1, 503, 1003);
	trans[0][317]	= settr(316,2,320,1,0,"(1)", 1, 503, 1003);
	trans[0][320]	= settr(319,2,321,171,171,"loom_r1 = 255", 1, 503, 1003);
		tr_2_src(171, "/tmp/pt/out/carpet_loom.loom.pml", 306);
	trans[0][321]	= settr(320,2,326,172,172,"loom_r1 = 6", 1, 503, 1003);
		tr_2_src(172, "/tmp/pt/out/carpet_loom.loom.pml", 307);
	trans[0][325]	= settr(324,2,326,1,0,".(goto)", 1, 503, 1003);
	trans[0][322]	= settr(321,2,323,173,173,"(!(((loom_r1==3)&&!(taken))))", 1, 503, 1003);
		tr_2_src(173, "/tmp/pt/out/carpet_loom.loom.pml", 308);
	trans[0][323]	= settr(322,2,326,1,0,"(1)", 1, 503, 1003);
	trans[0][326]	= settr(325,2,327,1,0,"(1)", 1, 503, 1003);
	trans[0][327]	= settr(326,2,9,174,174,"taken = 0", 1, 503, 1003);
		tr_2_src(174, "/tmp/pt/out/carpet_loom.loom.pml", 311);
	trans[0][328]	= settr(327,2,329,175,175,"loom_events?3", 1, 503, 1003);
		tr_2_src(175, "/tmp/pt/out/carpet_loom.loom.pml", 312);
	trans[0][329]	= settr(328,2,342,176,176,"taken = 0", 1, 503, 1003);
		tr_2_src(176, "/tmp/pt/out/carpet_loom.loom.pml", 313);
	T = trans[0][342] = settr(341,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:314 */
	T = T->nxt	= settr(341,2,330,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:314 */
	    T->nxt	= settr(341,2,340,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:314 */
	trans[0][330]	= settr(329,2,331,177,177,"(((loom_r1==3)&&!(taken)))", 1, 503, 1003);
		tr_2_src(177, "/tmp/pt/out/carpet_loom.loom.pml", 315);
	trans[0][331]	= settr(330,2,336,178,178,"taken = 1", 1, 503, 1003);
		tr_2_src(178, "/tmp/pt/out/carpet_loom.loom.pml", 316);
	T = trans[0][336] = settr(335,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:317 */
	T = T->nxt	= settr(335,2,332,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:317 */
	    T->nxt	= settr(335,2,334,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:317 */
	trans[0][332]	= settr(331,2,333,179,0,"((loom_r1==3))", 1, 503, 1003);
		tr_2_src(179, "/tmp/pt/out/carpet_loom.loom.pml", 318);
	trans[0][333]	= settr(332,2,338,180,180,"loom_r2 = 255", 1, 503, 1003);
		tr_2_src(180, "/tmp/pt/out/carpet_loom.loom.pml", 319);
	trans[0][337]	= settr(336,2,338,1,0,".(goto)", 1, 503, 1003);
	trans[0][334]	= settr(333,2,335,2,0,"else", 1, 503, 1003);
	trans[0][335]	= settr(334,2,338,1,0,"(1)", 1, 503, 1003);
	trans[0][338]	= settr(337,2,339,181,181,"loom_r1 = 255", 1, 503, 1003);
		tr_2_src(181, "/tmp/pt/out/carpet_loom.loom.pml", 322);
	trans[0][339]	= settr(338,2,344,182,182,"loom_r1 = 6", 1, 503, 1003);
		tr_2_src(182, "/tmp/pt/out/carpet_loom.loom.pml", 323);
	trans[0][343]	= settr(342,2,344,1,0,".(goto)", 1, 503, 1003);
	trans[0][340]	= settr(339,2,341,183,183,"(!(((loom_r1==3)&&!(taken))))", 1, 503, 1003);
		tr_2_src(183, "/tmp/pt/out/carpet_loom.loom.pml", 324);
	trans[0][341]	= settr(340,2,344,1,0,"(1)", 1, 503, 1003);
	trans[0][344]	= settr(343,2,345,1,0,"(1)", 1, 503, 1003);
	trans[0][345]	= settr(344,2,9,184,184,"taken = 0", 1, 503, 1003);
		tr_2_src(184, "/tmp/pt/out/carpet_loom.loom.pml", 327);
	trans[0][346]	= settr(345,2,347,185,185,"loom_events?4", 1, 503, 1003);
		tr_2_src(185, "/tmp/pt/out/carpet_loom.loom.pml", 328);
	trans[0][347]	= settr(346,2,360,186,186,"taken = 0", 1, 503, 1003);
		tr_2_src(186, "/tmp/pt/out/carpet_loom.loom.pml", 329);
	T = trans[0][360] = settr(359,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:330 */
	T = T->nxt	= settr(359,2,348,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:330 */
	    T->nxt	= settr(359,2,358,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:330 */
	trans[0][348]	= settr(347,2,349,187,187,"(((loom_r1==3)&&!(taken)))", 1, 503, 1003);
		tr_2_src(187, "/tmp/pt/out/carpet_loom.loom.pml", 331);
	trans[0][349]	= settr(348,2,354,188,188,"taken = 1", 1, 503, 1003);
		tr_2_src(188, "/tmp/pt/out/carpet_loom.loom.pml", 332);
	T = trans[0][354] = settr(353,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:333 */
	T = T->nxt	= settr(353,2,350,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:333 */
	    T->nxt	= settr(353,2,352,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:333 */
	trans[0][350]	= settr(349,2,351,189,0,"((loom_r1==3))", 1, 503, 1003);
		tr_2_src(189, "/tmp/pt/out/carpet_loom.loom.pml", 334);
	trans[0][351]	= settr(350,2,356,190,190,"loom_r2 = 255", 1, 503, 1003);
		tr_2_src(190, "/tmp/pt/out/carpet_loom.loom.pml", 335);
	trans[0][355]	= settr(354,2,356,1,0,".(goto)", 1, 503, 1003);
	trans[0][352]	= settr(351,2,353,2,0,"else", 1, 503, 1003);
	trans[0][353]	= settr(352,2,356,1,0,"(1)", 1, 503, 1003);
	trans[0][356]	= settr(355,2,357,191,191,"loom_r1 = 255", 1, 503, 1003);
		tr_2_src(191, "/tmp/pt/out/carpet_loom.loom.pml", 338);
	trans[0][357]	= settr(356,2,376,192,192,"loom_r1 = 2", 1, 503, 1003);
		tr_2_src(192, "/tmp/pt/out/carpet_loom.loom.pml", 339);
	trans[0][361]	= settr(360,2,376,1,0,".(goto)", 1, 503, 1003);
	trans[0][358]	= settr(357,2,359,193,0,"(!(((loom_r1==3)&&!(taken))))", 1, 503, 1003);
		tr_2_src(193, "/tmp/pt/out/carpet_loom.loom.pml", 340);
	trans[0][359]	= settr(358,2,376,1,0,"(1)", 1, 503, 1003);
	T = trans[0][376] = settr(375,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:342 */
	T = T->nxt	= settr(375,2,362,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:342 */
	T = T->nxt	= settr(375,2,372,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:342 */
	    T->nxt	= settr(375,2,374,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:342 */
	trans[0][362]	= settr(361,2,363,194,194,"(((loom_r1==6)&&!(taken)))", 1, 503, 1003);
		tr_2_src(194, "/tmp/pt/out/carpet_loom.loom.pml", 343);
	trans[0][363]	= settr(362,2,368,195,195,"taken = 1", 1, 503, 1003);
		tr_2_src(195, "/tmp/pt/out/carpet_loom.loom.pml", 344);
	T = trans[0][368] = settr(367,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:345 */
	T = T->nxt	= settr(367,2,364,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:345 */
	    T->nxt	= settr(367,2,366,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:345 */
	trans[0][364]	= settr(363,2,365,196,0,"((loom_r1==3))", 1, 503, 1003);
		tr_2_src(196, "/tmp/pt/out/carpet_loom.loom.pml", 346);
	trans[0][365]	= settr(364,2,370,197,197,"loom_r2 = 255", 1, 503, 1003);
		tr_2_src(197, "/tmp/pt/out/carpet_loom.loom.pml", 347);
	trans[0][369]	= settr(368,2,370,1,0,".(goto)", 1, 503, 1003);
	trans[0][366]	= settr(365,2,367,2,0,"else", 1, 503, 1003);
	trans[0][367]	= settr(366,2,370,1,0,"(1)", 1, 503, 1003);
	trans[0][370]	= settr(369,2,371,198,198,"loom_r1 = 255", 1, 503, 1003);
		tr_2_src(198, "/tmp/pt/out/carpet_loom.loom.pml", 350);
	trans[0][371]	= settr(370,2,390,199,199,"loom_r1 = 2", 1, 503, 1003);
		tr_2_src(199, "/tmp/pt/out/carpet_loom.loom.pml", 351);
	trans[0][377]	= settr(376,2,390,1,0,".(goto)", 1, 503, 1003);
	trans[0][372]	= settr(371,2,373,200,0,"(((loom_r1==6)&&!(taken)))", 1, 503, 1003);
		tr_2_src(200, "/tmp/pt/out/carpet_loom.loom.pml", 352);
	trans[0][373]	= settr(372,2,390,1,0,"(1)", 1, 503, 1003);
	trans[0][374]	= settr(373,2,375,201,0,"(!(((loom_r1==6)&&!(taken))))", 1, 503, 1003);
		tr_2_src(201, "/tmp/pt/out/carpet_loom.loom.pml", 354);
	trans[0][375]	= settr(374,2,390,1,0,"(1)", 1, 503, 1003);
	T = trans[0][390] = settr(389,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:356 */
	T = T->nxt	= settr(389,2,378,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:356 */
	    T->nxt	= settr(389,2,388,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:356 */
	trans[0][378]	= settr(377,2,379,202,202,"(((loom_r1==6)&&!(taken)))", 1, 503, 1003);
		tr_2_src(202, "/tmp/pt/out/carpet_loom.loom.pml", 357);
	trans[0][379]	= settr(378,2,384,203,203,"taken = 1", 1, 503, 1003);
		tr_2_src(203, "/tmp/pt/out/carpet_loom.loom.pml", 358);
	T = trans[0][384] = settr(383,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:359 */
	T = T->nxt	= settr(383,2,380,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:359 */
	    T->nxt	= settr(383,2,382,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:359 */
	trans[0][380]	= settr(379,2,381,204,0,"((loom_r1==3))", 1, 503, 1003);
		tr_2_src(204, "/tmp/pt/out/carpet_loom.loom.pml", 360);
	trans[0][381]	= settr(380,2,386,205,205,"loom_r2 = 255", 1, 503, 1003);
		tr_2_src(205, "/tmp/pt/out/carpet_loom.loom.pml", 361);
	trans[0][385]	= settr(384,2,386,1,0,".(goto)", 1, 503, 1003);
	trans[0][382]	= settr(381,2,383,2,0,"else", 1, 503, 1003);
	trans[0][383]	= settr(382,2,386,1,0,"(1)", 1, 503, 1003);
	trans[0][386]	= settr(385,2,387,206,206,"loom_r1 = 255", 1, 503, 1003);
		tr_2_src(206, "/tmp/pt/out/carpet_loom.loom.pml", 364);
	trans[0][387]	= settr(386,2,392,207,207,"loom_r1 = 7", 1, 503, 1003);
		tr_2_src(207, "/tmp/pt/out/carpet_loom.loom.pml", 365);
	trans[0][391]	= settr(390,2,392,1,0,".(goto)", 1, 503, 1003);
	trans[0][388]	= settr(387,2,389,208,208,"(!(((loom_r1==6)&&!(taken))))", 1, 503, 1003);
		tr_2_src(208, "/tmp/pt/out/carpet_loom.loom.pml", 366);
	trans[0][389]	= settr(388,2,392,1,0,"(1)", 1, 503, 1003);
	trans[0][392]	= settr(391,2,393,1,0,"(1)", 1, 503, 1003);
	trans[0][393]	= settr(392,2,9,209,209,"taken = 0", 1, 503, 1003);
		tr_2_src(209, "/tmp/pt/out/carpet_loom.loom.pml", 369);
	trans[0][394]	= settr(393,2,395,210,210,"loom_events?5", 1, 503, 1003);
		tr_2_src(210, "/tmp/pt/out/carpet_loom.loom.pml", 370);
	trans[0][395]	= settr(394,2,410,211,211,"taken = 0", 1, 503, 1003);
		tr_2_src(211, "/tmp/pt/out/carpet_loom.loom.pml", 371);
	T = trans[0][410] = settr(409,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:372 */
	T = T->nxt	= settr(409,2,396,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:372 */
	T = T->nxt	= settr(409,2,406,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:372 */
	    T->nxt	= settr(409,2,408,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:372 */
	trans[0][396]	= settr(395,2,397,212,212,"(((loom_r1==7)&&!(taken)))", 1, 503, 1003);
		tr_2_src(212, "/tmp/pt/out/carpet_loom.loom.pml", 373);
	trans[0][397]	= settr(396,2,402,213,213,"taken = 1", 1, 503, 1003);
		tr_2_src(213, "/tmp/pt/out/carpet_loom.loom.pml", 374);
	T = trans[0][402] = settr(401,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:375 */
	T = T->nxt	= settr(401,2,398,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:375 */
	    T->nxt	= settr(401,2,400,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:375 */
	trans[0][398]	= settr(397,2,399,214,0,"((loom_r1==3))", 1, 503, 1003);
		tr_2_src(214, "/tmp/pt/out/carpet_loom.loom.pml", 376);
	trans[0][399]	= settr(398,2,404,215,215,"loom_r2 = 255", 1, 503, 1003);
		tr_2_src(215, "/tmp/pt/out/carpet_loom.loom.pml", 377);
	trans[0][403]	= settr(402,2,404,1,0,".(goto)", 1, 503, 1003);
	trans[0][400]	= settr(399,2,401,2,0,"else", 1, 503, 1003);
	trans[0][401]	= settr(400,2,404,1,0,"(1)", 1, 503, 1003);
	trans[0][404]	= settr(403,2,405,216,216,"loom_r1 = 255", 1, 503, 1003);
		tr_2_src(216, "/tmp/pt/out/carpet_loom.loom.pml", 380);
	trans[0][405]	= settr(404,2,433,217,217,"loom_r1 = 1", 1, 503, 1003);
		tr_2_src(217, "/tmp/pt/out/carpet_loom.loom.pml", 381);
	trans[0][411]	= settr(410,2,433,1,0,".(goto)", 1, 503, 1003);
	trans[0][406]	= settr(405,2,407,218,0,"(((loom_r1==7)&&!(taken)))", 1, 503, 1003);
		tr_2_src(218, "/tmp/pt/out/carpet_loom.loom.pml", 382);
	trans[0][407]	= settr(406,2,433,1,0,"(1)", 1, 503, 1003);
	trans[0][408]	= settr(407,2,409,219,0,"(!(((loom_r1==7)&&!(taken))))", 1, 503, 1003);
		tr_2_src(219, "/tmp/pt/out/carpet_loom.loom.pml", 384);
	trans[0][409]	= settr(408,2,433,1,0,"(1)", 1, 503, 1003);
	T = trans[0][433] = settr(432,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:386 */
	T = T->nxt	= settr(432,2,412,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:386 */
	T = T->nxt	= settr(432,2,429,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:386 */
	    T->nxt	= settr(432,2,431,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:386 */
	trans[0][412]	= settr(411,2,413,220,220,"(((loom_r0==8)&&!(taken)))", 1, 503, 1003);
		tr_2_src(220, "/tmp/pt/out/carpet_loom.loom.pml", 387);
	trans[0][413]	= settr(412,2,424,221,221,"taken = 1", 1, 503, 1003);
		tr_2_src(221, "/tmp/pt/out/carpet_loom.loom.pml", 388);
	T = trans[0][424] = settr(423,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:389 */
	T = T->nxt	= settr(423,2,414,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:389 */
	    T->nxt	= settr(423,2,422,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:389 */
	trans[0][414]	= settr(413,2,419,222,0,"((loom_r0==0))", 1, 503, 1003);
		tr_2_src(222, "/tmp/pt/out/carpet_loom.loom.pml", 390);
	T = trans[0][419] = settr(418,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:391 */
	T = T->nxt	= settr(418,2,415,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:391 */
	    T->nxt	= settr(418,2,417,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:391 */
	trans[0][415]	= settr(414,2,416,223,0,"((loom_r1==3))", 1, 503, 1003);
		tr_2_src(223, "/tmp/pt/out/carpet_loom.loom.pml", 392);
	trans[0][416]	= settr(415,2,421,224,224,"loom_r2 = 255", 1, 503, 1003);
		tr_2_src(224, "/tmp/pt/out/carpet_loom.loom.pml", 393);
	trans[0][420]	= settr(419,2,421,1,0,".(goto)", 1, 503, 1003);
	trans[0][417]	= settr(416,2,418,2,0,"else", 1, 503, 1003);
	trans[0][418]	= settr(417,2,421,1,0,"(1)", 1, 503, 1003);
	trans[0][421]	= settr(420,2,426,225,225,"loom_r1 = 255", 1, 503, 1003);
		tr_2_src(225, "/tmp/pt/out/carpet_loom.loom.pml", 396);
	trans[0][425]	= settr(424,2,426,1,0,".(goto)", 1, 503, 1003);
	trans[0][422]	= settr(421,2,423,2,0,"else", 1, 503, 1003);
	trans[0][423]	= settr(422,2,426,1,0,"(1)", 1, 503, 1003);
	trans[0][426]	= settr(425,2,427,226,226,"loom_r0 = 255", 1, 503, 1003);
		tr_2_src(226, "/tmp/pt/out/carpet_loom.loom.pml", 399);
	trans[0][427]	= settr(426,2,428,227,227,"loom_r0 = 0", 1, 503, 1003);
		tr_2_src(227, "/tmp/pt/out/carpet_loom.loom.pml", 400);
	trans[0][428]	= settr(427,2,456,228,228,"loom_r1 = 1", 1, 503, 1003);
		tr_2_src(228, "/tmp/pt/out/carpet_loom.loom.pml", 401);
	trans[0][434]	= settr(433,2,456,1,0,".(goto)", 1, 503, 1003);
	trans[0][429]	= settr(428,2,430,229,0,"(((loom_r0==8)&&!(taken)))", 1, 503, 1003);
		tr_2_src(229, "/tmp/pt/out/carpet_loom.loom.pml", 402);
	trans[0][430]	= settr(429,2,456,1,0,"(1)", 1, 503, 1003);
	trans[0][431]	= settr(430,2,432,230,0,"(!(((loom_r0==8)&&!(taken))))", 1, 503, 1003);
		tr_2_src(230, "/tmp/pt/out/carpet_loom.loom.pml", 404);
	trans[0][432]	= settr(431,2,456,1,0,"(1)", 1, 503, 1003);
	T = trans[0][456] = settr(455,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:406 */
	T = T->nxt	= settr(455,2,435,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:406 */
	T = T->nxt	= settr(455,2,452,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:406 */
	    T->nxt	= settr(455,2,454,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:406 */
	trans[0][435]	= settr(434,2,436,231,231,"(((loom_r0==9)&&!(taken)))", 1, 503, 1003);
		tr_2_src(231, "/tmp/pt/out/carpet_loom.loom.pml", 407);
	trans[0][436]	= settr(435,2,447,232,232,"taken = 1", 1, 503, 1003);
		tr_2_src(232, "/tmp/pt/out/carpet_loom.loom.pml", 408);
	T = trans[0][447] = settr(446,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:409 */
	T = T->nxt	= settr(446,2,437,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:409 */
	    T->nxt	= settr(446,2,445,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:409 */
	trans[0][437]	= settr(436,2,442,233,0,"((loom_r0==0))", 1, 503, 1003);
		tr_2_src(233, "/tmp/pt/out/carpet_loom.loom.pml", 410);
	T = trans[0][442] = settr(441,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:411 */
	T = T->nxt	= settr(441,2,438,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:411 */
	    T->nxt	= settr(441,2,440,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:411 */
	trans[0][438]	= settr(437,2,439,234,0,"((loom_r1==3))", 1, 503, 1003);
		tr_2_src(234, "/tmp/pt/out/carpet_loom.loom.pml", 412);
	trans[0][439]	= settr(438,2,444,235,235,"loom_r2 = 255", 1, 503, 1003);
		tr_2_src(235, "/tmp/pt/out/carpet_loom.loom.pml", 413);
	trans[0][443]	= settr(442,2,444,1,0,".(goto)", 1, 503, 1003);
	trans[0][440]	= settr(439,2,441,2,0,"else", 1, 503, 1003);
	trans[0][441]	= settr(440,2,444,1,0,"(1)", 1, 503, 1003);
	trans[0][444]	= settr(443,2,449,236,236,"loom_r1 = 255", 1, 503, 1003);
		tr_2_src(236, "/tmp/pt/out/carpet_loom.loom.pml", 416);
	trans[0][448]	= settr(447,2,449,1,0,".(goto)", 1, 503, 1003);
	trans[0][445]	= settr(444,2,446,2,0,"else", 1, 503, 1003);
	trans[0][446]	= settr(445,2,449,1,0,"(1)", 1, 503, 1003);
	trans[0][449]	= settr(448,2,450,237,237,"loom_r0 = 255", 1, 503, 1003);
		tr_2_src(237, "/tmp/pt/out/carpet_loom.loom.pml", 419);
	trans[0][450]	= settr(449,2,451,238,238,"loom_r0 = 0", 1, 503, 1003);
		tr_2_src(238, "/tmp/pt/out/carpet_loom.loom.pml", 420);
	trans[0][451]	= settr(450,2,458,239,239,"loom_r1 = 1", 1, 503, 1003);
		tr_2_src(239, "/tmp/pt/out/carpet_loom.loom.pml", 421);
	trans[0][457]	= settr(456,2,458,1,0,".(goto)", 1, 503, 1003);
	trans[0][452]	= settr(451,2,453,240,240,"(((loom_r0==9)&&!(taken)))", 1, 503, 1003);
		tr_2_src(240, "/tmp/pt/out/carpet_loom.loom.pml", 422);
	trans[0][453]	= settr(452,2,458,1,0,"(1)", 1, 503, 1003);
	trans[0][454]	= settr(453,2,455,241,241,"(!(((loom_r0==9)&&!(taken))))", 1, 503, 1003);
		tr_2_src(241, "/tmp/pt/out/carpet_loom.loom.pml", 424);
	trans[0][455]	= settr(454,2,458,1,0,"(1)", 1, 503, 1003);
	trans[0][458]	= settr(457,2,459,1,0,"(1)", 1, 503, 1003);
	trans[0][459]	= settr(458,2,9,242,242,"taken = 0", 1, 503, 1003);
		tr_2_src(242, "/tmp/pt/out/carpet_loom.loom.pml", 427);
	trans[0][460]	= settr(459,2,461,243,243,"loom_events?6", 1, 503, 1003);
		tr_2_src(243, "/tmp/pt/out/carpet_loom.loom.pml", 428);
	trans[0][461]	= settr(460,2,480,244,244,"taken = 0", 1, 503, 1003);
		tr_2_src(244, "/tmp/pt/out/carpet_loom.loom.pml", 429);
	T = trans[0][480] = settr(479,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:430 */
	T = T->nxt	= settr(479,2,462,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:430 */
	    T->nxt	= settr(479,2,478,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:430 */
	trans[0][462]	= settr(461,2,463,245,245,"(((loom_r0==0)&&!(taken)))", 1, 503, 1003);
		tr_2_src(245, "/tmp/pt/out/carpet_loom.loom.pml", 431);
	trans[0][463]	= settr(462,2,474,246,246,"taken = 1", 1, 503, 1003);
		tr_2_src(246, "/tmp/pt/out/carpet_loom.loom.pml", 432);
	T = trans[0][474] = settr(473,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:433 */
	T = T->nxt	= settr(473,2,464,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:433 */
	    T->nxt	= settr(473,2,472,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:433 */
	trans[0][464]	= settr(463,2,469,247,0,"((loom_r0==0))", 1, 503, 1003);
		tr_2_src(247, "/tmp/pt/out/carpet_loom.loom.pml", 434);
	T = trans[0][469] = settr(468,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:435 */
	T = T->nxt	= settr(468,2,465,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:435 */
	    T->nxt	= settr(468,2,467,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:435 */
	trans[0][465]	= settr(464,2,466,248,0,"((loom_r1==3))", 1, 503, 1003);
		tr_2_src(248, "/tmp/pt/out/carpet_loom.loom.pml", 436);
	trans[0][466]	= settr(465,2,471,249,249,"loom_r2 = 255", 1, 503, 1003);
		tr_2_src(249, "/tmp/pt/out/carpet_loom.loom.pml", 437);
	trans[0][470]	= settr(469,2,471,1,0,".(goto)", 1, 503, 1003);
	trans[0][467]	= settr(466,2,468,2,0,"else", 1, 503, 1003);
	trans[0][468]	= settr(467,2,471,1,0,"(1)", 1, 503, 1003);
	trans[0][471]	= settr(470,2,476,250,250,"loom_r1 = 255", 1, 503, 1003);
		tr_2_src(250, "/tmp/pt/out/carpet_loom.loom.pml", 440);
	trans[0][475]	= settr(474,2,476,1,0,".(goto)", 1, 503, 1003);
	trans[0][472]	= settr(471,2,473,2,0,"else", 1, 503, 1003);
	trans[0][473]	= settr(472,2,476,1,0,"(1)", 1, 503, 1003);
	trans[0][476]	= settr(475,2,477,251,251,"loom_r0 = 255", 1, 503, 1003);
		tr_2_src(251, "/tmp/pt/out/carpet_loom.loom.pml", 443);
	trans[0][477]	= settr(476,2,482,252,252,"loom_r0 = 8", 1, 503, 1003);
		tr_2_src(252, "/tmp/pt/out/carpet_loom.loom.pml", 444);
	trans[0][481]	= settr(480,2,482,1,0,".(goto)", 1, 503, 1003);
	trans[0][478]	= settr(477,2,479,253,253,"(!(((loom_r0==0)&&!(taken))))", 1, 503, 1003);
		tr_2_src(253, "/tmp/pt/out/carpet_loom.loom.pml", 445);
	trans[0][479]	= settr(478,2,482,1,0,"(1)", 1, 503, 1003);
	trans[0][482]	= settr(481,2,483,1,0,"(1)", 1, 503, 1003);
	trans[0][483]	= settr(482,2,9,254,254,"taken = 0", 1, 503, 1003);
		tr_2_src(254, "/tmp/pt/out/carpet_loom.loom.pml", 448);
	trans[0][484]	= settr(483,2,485,255,255,"loom_events?7", 1, 503, 1003);
		tr_2_src(255, "/tmp/pt/out/carpet_loom.loom.pml", 449);
	trans[0][485]	= settr(484,2,504,256,256,"taken = 0", 1, 503, 1003);
		tr_2_src(256, "/tmp/pt/out/carpet_loom.loom.pml", 450);
	T = trans[0][504] = settr(503,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:451 */
	T = T->nxt	= settr(503,2,486,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:451 */
	    T->nxt	= settr(503,2,502,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:451 */
	trans[0][486]	= settr(485,2,487,257,257,"(((loom_r0==0)&&!(taken)))", 1, 503, 1003);
		tr_2_src(257, "/tmp/pt/out/carpet_loom.loom.pml", 452);
	trans[0][487]	= settr(486,2,498,258,258,"taken = 1", 1, 503, 1003);
		tr_2_src(258, "/tmp/pt/out/carpet_loom.loom.pml", 453);
	T = trans[0][498] = settr(497,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:454 */
	T = T->nxt	= settr(497,2,488,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:454 */
	    T->nxt	= settr(497,2,496,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:454 */
	trans[0][488]	= settr(487,2,493,259,0,"((loom_r0==0))", 1, 503, 1003);
		tr_2_src(259, "/tmp/pt/out/carpet_loom.loom.pml", 455);
	T = trans[0][493] = settr(492,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:456 */
	T = T->nxt	= settr(492,2,489,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:456 */
	    T->nxt	= settr(492,2,491,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:456 */
	trans[0][489]	= settr(488,2,490,260,0,"((loom_r1==3))", 1, 503, 1003);
		tr_2_src(260, "/tmp/pt/out/carpet_loom.loom.pml", 457);
	trans[0][490]	= settr(489,2,495,261,261,"loom_r2 = 255", 1, 503, 1003);
		tr_2_src(261, "/tmp/pt/out/carpet_loom.loom.pml", 458);
	trans[0][494]	= settr(493,2,495,1,0,".(goto)", 1, 503, 1003);
	trans[0][491]	= settr(490,2,492,2,0,"else", 1, 503, 1003);
	trans[0][492]	= settr(491,2,495,1,0,"(1)", 1, 503, 1003);
	trans[0][495]	= settr(494,2,500,262,262,"loom_r1 = 255", 1, 503, 1003);
		tr_2_src(262, "/tmp/pt/out/carpet_loom.loom.pml", 461);
	trans[0][499]	= settr(498,2,500,1,0,".(goto)", 1, 503, 1003);
	trans[0][496]	= settr(495,2,497,2,0,"else", 1, 503, 1003);
	trans[0][497]	= settr(496,2,500,1,0,"(1)", 1, 503, 1003);
	trans[0][500]	= settr(499,2,501,263,263,"loom_r0 = 255", 1, 503, 1003);
		tr_2_src(263, "/tmp/pt/out/carpet_loom.loom.pml", 464);
	trans[0][501]	= settr(500,2,506,264,264,"loom_r0 = 9", 1, 503, 1003);
		tr_2_src(264, "/tmp/pt/out/carpet_loom.loom.pml", 465);
	trans[0][505]	= settr(504,2,506,1,0,".(goto)", 1, 503, 1003);
	trans[0][502]	= settr(501,2,503,265,265,"(!(((loom_r0==0)&&!(taken))))", 1, 503, 1003);
		tr_2_src(265, "/tmp/pt/out/carpet_loom.loom.pml", 466);
	trans[0][503]	= settr(502,2,506,1,0,"(1)", 1, 503, 1003);
	trans[0][506]	= settr(505,2,507,1,0,"(1)", 1, 503, 1003);
	trans[0][507]	= settr(506,2,9,266,266,"taken = 0", 1, 503, 1003);
		tr_2_src(266, "/tmp/pt/out/carpet_loom.loom.pml", 469);
	trans[0][508]	= settr(507,2,559,267,0,"((loom_wants_final||loom_wants_initial))", 1, 503, 1003);
		tr_2_src(267, "/tmp/pt/out/carpet_loom.loom.pml", 470);
	trans[0][509]	= settr(508,2,559,1,0,"goto loom_request", 1, 503, 1003);
	trans[0][510]	= settr(509,2,515,268,0,"(((loom_r0==10)&&empty(loom_events)))", 1, 503, 1003);
		tr_2_src(268, "/tmp/pt/out/carpet_loom.loom.pml", 471);
	trans[0][511]	= settr(510,2,515,1,0,"goto end_loom", 1, 503, 1003);
	trans[0][514]	= settr(513,2,9,1,0,"goto loom_loop", 1, 503, 1003);
	trans[0][515]	= settr(514,2,9,269,0,"(((nempty(loom_events)||loom_wants_initial)||loom_wants_final))", 1, 503, 1003);
		tr_2_src(269, "/tmp/pt/out/carpet_loom.loom.pml", 475);
	trans[0][516]	= settr(515,2,9,1,0,"goto loom_loop", 1, 503, 1003);
	T = trans[0][559] = settr(558,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:478 */
	T = T->nxt	= settr(558,2,517,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:478 */
	T = T->nxt	= settr(558,2,536,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:478 */
	T = T->nxt	= settr(558,2,538,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:478 */
	    T->nxt	= settr(558,2,540,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:478 */
	trans[0][517]	= settr(516,2,528,270,0,"((loom_wants_final&&!((loom_r0==10))))", 1, 503, 1003);
		tr_2_src(270, "/tmp/pt/out/carpet_loom.loom.pml", 479);
	T = trans[0][528] = settr(527,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:480 */
	T = T->nxt	= settr(527,2,518,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:480 */
	    T->nxt	= settr(527,2,526,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:480 */
	trans[0][518]	= settr(517,2,523,271,0,"((loom_r0==0))", 1, 503, 1003);
		tr_2_src(271, "/tmp/pt/out/carpet_loom.loom.pml", 481);
	T = trans[0][523] = settr(522,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:482 */
	T = T->nxt	= settr(522,2,519,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:482 */
	    T->nxt	= settr(522,2,521,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:482 */
	trans[0][519]	= settr(518,2,520,272,0,"((loom_r1==3))", 1, 503, 1003);
		tr_2_src(272, "/tmp/pt/out/carpet_loom.loom.pml", 483);
	trans[0][520]	= settr(519,2,525,273,273,"loom_r2 = 255", 1, 503, 1003);
		tr_2_src(273, "/tmp/pt/out/carpet_loom.loom.pml", 484);
	trans[0][524]	= settr(523,2,525,1,0,".(goto)", 1, 503, 1003);
	trans[0][521]	= settr(520,2,522,2,0,"else", 1, 503, 1003);
	trans[0][522]	= settr(521,2,525,1,0,"(1)", 1, 503, 1003);
	trans[0][525]	= settr(524,2,530,274,274,"loom_r1 = 255", 1, 503, 1003);
		tr_2_src(274, "/tmp/pt/out/carpet_loom.loom.pml", 487);
	trans[0][529]	= settr(528,2,530,1,0,".(goto)", 1, 503, 1003);
	trans[0][526]	= settr(525,2,527,2,0,"else", 1, 503, 1003);
	trans[0][527]	= settr(526,2,530,1,0,"(1)", 1, 503, 1003);
	trans[0][530]	= settr(529,2,531,275,275,"loom_r0 = 255", 1, 503, 1003);
		tr_2_src(275, "/tmp/pt/out/carpet_loom.loom.pml", 490);
	trans[0][531]	= settr(530,2,532,276,276,"loom_wants_final = 0", 1, 503, 1003);
		tr_2_src(276, "/tmp/pt/out/carpet_loom.loom.pml", 491);
	trans[0][532]	= settr(531,2,533,277,277,"loom_error = 0", 1, 503, 1003);
		tr_2_src(277, "/tmp/pt/out/carpet_loom.loom.pml", 492);
	trans[0][533]	= settr(532,2,534,278,278,"at = 0", 1, 503, 1003);
		tr_2_src(278, "/tmp/pt/out/carpet_loom.loom.pml", 493);
	trans[0][534]	= settr(533,2,535,279,279,"loom_r0 = 10", 1, 503, 1003);
		tr_2_src(279, "/tmp/pt/out/carpet_loom.loom.pml", 494);
	trans[0][535]	= settr(534,2,9,1,0,"(1)", 1, 503, 1003);
	trans[0][560]	= settr(559,2,9,1,0,".(goto)", 1, 503, 1003);
	trans[0][536]	= settr(535,2,537,280,0,"((loom_wants_final&&(loom_r0==10)))", 1, 503, 1003);
		tr_2_src(280, "/tmp/pt/out/carpet_loom.loom.pml", 496);
	trans[0][537]	= settr(536,2,9,281,281,"loom_wants_final = 0", 1, 503, 1003);
		tr_2_src(281, "/tmp/pt/out/carpet_loom.loom.pml", 496);
	trans[0][538]	= settr(537,2,539,282,0,"((loom_wants_initial&&!((loom_r0==10))))", 1, 503, 1003);
		tr_2_src(282, "/tmp/pt/out/carpet_loom.loom.pml", 497);
	trans[0][539]	= settr(538,2,9,283,283,"loom_wants_initial = 0", 1, 503, 1003);
		tr_2_src(283, "/tmp/pt/out/carpet_loom.loom.pml", 497);
	trans[0][540]	= settr(539,2,551,284,0,"((loom_wants_initial&&(loom_r0==10)))", 1, 503, 1003);
		tr_2_src(284, "/tmp/pt/out/carpet_loom.loom.pml", 498);
	T = trans[0][551] = settr(550,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:499 */
	T = T->nxt	= settr(550,2,541,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:499 */
	    T->nxt	= settr(550,2,549,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:499 */
	trans[0][541]	= settr(540,2,546,285,0,"((loom_r0==0))", 1, 503, 1003);
		tr_2_src(285, "/tmp/pt/out/carpet_loom.loom.pml", 500);
	T = trans[0][546] = settr(545,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:501 */
	T = T->nxt	= settr(545,2,542,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:501 */
	    T->nxt	= settr(545,2,544,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:501 */
	trans[0][542]	= settr(541,2,543,286,0,"((loom_r1==3))", 1, 503, 1003);
		tr_2_src(286, "/tmp/pt/out/carpet_loom.loom.pml", 502);
	trans[0][543]	= settr(542,2,548,287,287,"loom_r2 = 255", 1, 503, 1003);
		tr_2_src(287, "/tmp/pt/out/carpet_loom.loom.pml", 503);
	trans[0][547]	= settr(546,2,548,1,0,".(goto)", 1, 503, 1003);
	trans[0][544]	= settr(543,2,545,2,0,"else", 1, 503, 1003);
	trans[0][545]	= settr(544,2,548,1,0,"(1)", 1, 503, 1003);
	trans[0][548]	= settr(547,2,553,288,288,"loom_r1 = 255", 1, 503, 1003);
		tr_2_src(288, "/tmp/pt/out/carpet_loom.loom.pml", 506);
	trans[0][552]	= settr(551,2,553,1,0,".(goto)", 1, 503, 1003);
	trans[0][549]	= settr(548,2,550,2,0,"else", 1, 503, 1003);
	trans[0][550]	= settr(549,2,553,1,0,"(1)", 1, 503, 1003);
	trans[0][553]	= settr(552,2,554,289,289,"loom_r0 = 255", 1, 503, 1003);
		tr_2_src(289, "/tmp/pt/out/carpet_loom.loom.pml", 509);
	trans[0][554]	= settr(553,2,555,290,290,"loom_wants_initial = 0", 1, 503, 1003);
		tr_2_src(290, "/tmp/pt/out/carpet_loom.loom.pml", 510);
	trans[0][555]	= settr(554,2,556,291,291,"at = 0", 1, 503, 1003);
		tr_2_src(291, "/tmp/pt/out/carpet_loom.loom.pml", 511);
	trans[0][556]	= settr(555,2,557,292,292,"loom_r0 = 0", 1, 503, 1003);
		tr_2_src(292, "/tmp/pt/out/carpet_loom.loom.pml", 512);
	trans[0][557]	= settr(556,2,558,293,293,"loom_r1 = 1", 1, 503, 1003);
		tr_2_src(293, "/tmp/pt/out/carpet_loom.loom.pml", 513);
	trans[0][558]	= settr(557,2,9,1,0,"(1)", 1, 503, 1003);
	trans[0][561]	= settr(560,2,9,1,0,"goto loom_loop", 1, 503, 1003);
	trans[0][562]	= settr(561,2,563,294,294,"loom_error = 1", 1, 503, 1003);
		tr_2_src(294, "/tmp/pt/out/carpet_loom.loom.pml", 518);
	trans[0][563]	= settr(562,2,569,295,295,"at = 0", 1, 503, 1003);
		tr_2_src(295, "/tmp/pt/out/carpet_loom.loom.pml", 519);
	T = trans[0][569] = settr(568,2,0,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:521 */
	T = T->nxt	= settr(568,2,564,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:521 */
	T = T->nxt	= settr(568,2,565,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:521 */
	    T->nxt	= settr(568,2,567,0,0,"IF", 1, 503, 1003);
		/* /tmp/pt/out/carpet_loom.loom.pml:521 */
	trans[0][564]	= settr(563,2,569,296,296,"loom_events?_", 1, 503, 1003);
		tr_2_src(296, "/tmp/pt/out/carpet_loom.loom.pml", 522);
	trans[0][570]	= settr(569,2,569,1,0,".(goto)", 1, 503, 1003);
	trans[0][565]	= settr(564,2,566,297,0,"(loom_wants_initial)", 1, 503, 1003);
		tr_2_src(297, "/tmp/pt/out/carpet_loom.loom.pml", 523);
	trans[0][566]	= settr(565,2,569,298,298,"loom_wants_initial = 0", 1, 503, 1003);
		tr_2_src(298, "/tmp/pt/out/carpet_loom.loom.pml", 523);
	trans[0][567]	= settr(566,2,559,299,0,"(loom_wants_final)", 1, 503, 1003);
		tr_2_src(299, "/tmp/pt/out/carpet_loom.loom.pml", 524);
	trans[0][568]	= settr(567,2,559,1,0,"goto loom_request", 1, 503, 1003);
	trans[0][571]	= settr(570,2,569,1,0,"goto end_loom_error", 1, 503, 1003);
	trans[0][573]	= settr(572,0,0,300,300,"-end-", 0, 3500, 0);
		tr_2_src(300, "/tmp/pt/out/carpet_loom.loom.pml", 528);
	/* np_ demon: */
	trans[_NP_] = (Trans **) emalloc(3*sizeof(Trans *));
	T = trans[_NP_][0] = settr(9997,0,1,_T5,0,"(np_)", 1,2,0);
	    T->nxt	  = settr(9998,0,0,_T2,0,"(1)",   0,2,0);
	T = trans[_NP_][1] = settr(9999,0,1,_T5,0,"(np_)", 1,2,0);
}

Trans *
settr(	int t_id, int a, int b, int c, int d,
	char *t, int g, int tpe0, int tpe1)
{	Trans *tmp = (Trans *) emalloc(sizeof(Trans));

	tmp->atom  = a&(6|32);	/* only (2|8|32) have meaning */
	if (!g) tmp->atom |= 8;	/* no global references */
	tmp->st    = b;
	tmp->tpe[0] = tpe0;
	tmp->tpe[1] = tpe1;
	tmp->tp    = t;
	tmp->t_id  = t_id;
	tmp->forw  = c;
	tmp->back  = d;
	return tmp;
}

Trans *
cpytr(Trans *a)
{	Trans *tmp = (Trans *) emalloc(sizeof(Trans));

	int i;
	tmp->atom  = a->atom;
	tmp->st    = a->st;
#ifdef HAS_UNLESS
	tmp->e_trans = a->e_trans;
	for (i = 0; i < HAS_UNLESS; i++)
		tmp->escp[i] = a->escp[i];
#endif
	tmp->tpe[0] = a->tpe[0];
	tmp->tpe[1] = a->tpe[1];
	for (i = 0; i < 6; i++)
	{	tmp->qu[i] = a->qu[i];
		tmp->ty[i] = a->ty[i];
	}
	tmp->tp    = (char *) emalloc(strlen(a->tp)+1);
	strcpy(tmp->tp, a->tp);
	tmp->t_id  = a->t_id;
	tmp->forw  = a->forw;
	tmp->back  = a->back;
	return tmp;
}

#ifndef NOREDUCE
int
srinc_set(int n)
{	if (n <= 2) return LOCAL;
	if (n <= 2+  DELTA) return Q_FULL_F; /* 's' or nfull  */
	if (n <= 2+2*DELTA) return Q_EMPT_F; /* 'r' or nempty */
	if (n <= 2+3*DELTA) return Q_EMPT_T; /* empty */
	if (n <= 2+4*DELTA) return Q_FULL_T; /* full  */
	if (n ==   5*DELTA) return GLOBAL;
	if (n ==   6*DELTA) return TIMEOUT_F;
	if (n ==   7*DELTA) return ALPHA_F;
	Uerror("cannot happen srinc_class");
	return BAD;
}
int
srunc(int n, int m)
{	switch(m) {
	case Q_FULL_F: return n-2;
	case Q_EMPT_F: return n-2-DELTA;
	case Q_EMPT_T: return n-2-2*DELTA;
	case Q_FULL_T: return n-2-3*DELTA;
	case ALPHA_F:
	case TIMEOUT_F: return 257; /* non-zero, and > MAXQ */
	}
	Uerror("cannot happen srunc");
	return 0;
}
#endif
int cnt;
#ifdef HAS_UNLESS
int
isthere(Trans *a, int b)
{	Trans *t;
	for (t = a; t; t = t->nxt)
		if (t->t_id == b)
			return 1;
	return 0;
}
#endif
#ifndef NOREDUCE
int
mark_safety(Trans *t) /* for conditional safety */
{	int g = 0, i, j, k;

	if (!t) return 0;
	if (t->qu[0])
		return (t->qu[1])?2:1;	/* marked */

	for (i = 0; i < 2; i++)
	{	j = srinc_set(t->tpe[i]);
		if (j >= GLOBAL && j != ALPHA_F)
			return -1;
		if (j != LOCAL)
		{	k = srunc(t->tpe[i], j);
			if (g == 0
			||  t->qu[0] != k
			||  t->ty[0] != j)
			{	t->qu[g] = k;
				t->ty[g] = j;
				g++;
	}	}	}
	return g;
}
#endif
void
retrans(int n, int m, int is, short srcln[], uchar reach[], uchar lpstate[])
	/* process n, with m states, is=initial state */
{	Trans *T0, *T1, *T2, *T3;
	Trans *T4, *T5; /* t_reverse or has_unless */
	int i;
#if defined(HAS_UNLESS) || !defined(NOREDUCE)
	int k;
#endif
#ifndef NOREDUCE
	int g, h, j, aa;
#endif
#ifdef HAS_UNLESS
	int p;
#endif
	if (state_tables >= 4)
	{	printf("STEP 1 %s\n", 
			procname[n]);
		for (i = 1; i < m; i++)
		for (T0 = trans[n][i]; T0; T0 = T0->nxt)
			crack(n, i, T0, srcln);
		return;
	}
	do {
		for (i = 1, cnt = 0; i < m; i++)
		{	T2 = trans[n][i];
			T1 = T2?T2->nxt:(Trans *)0;
/* prescan: */		for (T0 = T1; T0; T0 = T0->nxt)
/* choice in choice */	{	if (T0->st && trans[n][T0->st]
				&&  trans[n][T0->st]->nxt)
					break;
			}
#if 0
		if (T0)
		printf("\tstate %d / %d: choice in choice\n",
		i, T0->st);
#endif
			if (T0)
			for (T0 = T1; T0; T0 = T0->nxt)
			{	T3 = trans[n][T0->st];
				if (!T3->nxt)
				{	T2->nxt = cpytr(T0);
					T2 = T2->nxt;
					imed(T2, T0->st, n, i);
					continue;
				}
				do {	T3 = T3->nxt;
					T2->nxt = cpytr(T3);
					T2 = T2->nxt;
					imed(T2, T0->st, n, i);
				} while (T3->nxt);
				cnt++;
			}
		}
	} while (cnt);
	if (state_tables >= 3)
	{	printf("STEP 2 %s\n", 
			procname[n]);
		for (i = 1; i < m; i++)
		for (T0 = trans[n][i]; T0; T0 = T0->nxt)
			crack(n, i, T0, srcln);
		return;
	}
	for (i = 1; i < m; i++)
	{	if (trans[n][i] && trans[n][i]->nxt) /* optimize */
		{	T1 = trans[n][i]->nxt;
#if 0
			printf("\t\tpull %d (%d) to %d\n",
			T1->st, T1->forw, i);
#endif
			srcln[i] = srcln[T1->st];	/* Oyvind Teig, 5.2.0 */

			if (!trans[n][T1->st]) continue;
			T0 = cpytr(trans[n][T1->st]);
			trans[n][i] = T0;
			reach[T1->st] = 1;
			imed(T0, T1->st, n, i);
			for (T1 = T1->nxt; T1; T1 = T1->nxt)
			{
#if 0
			printf("\t\tpull %d (%d) to %d\n",
				T1->st, T1->forw, i);
#endif
		/*		srcln[i] = srcln[T1->st];  gh: not useful */
				if (!trans[n][T1->st]) continue;
				T0->nxt = cpytr(trans[n][T1->st]);
				T0 = T0->nxt;
				reach[T1->st] = 1;
				imed(T0, T1->st, n, i);
	}	}	}
	if (state_tables >= 2)
	{	printf("STEP 3 %s\n", 
			procname[n]);
		for (i = 1; i < m; i++)
		for (T0 = trans[n][i]; T0; T0 = T0->nxt)
			crack(n, i, T0, srcln);
		return;
	}
#ifdef HAS_UNLESS
	for (i = 1; i < m; i++)
	{	if (!trans[n][i]) continue;
		/* check for each state i if an
		 * escape to some state p is defined
		 * if so, copy and mark p's transitions
		 * and prepend them to the transition-
		 * list of state i
		 */
	 if (!like_java) /* the default */
	 {	for (T0 = trans[n][i]; T0; T0 = T0->nxt)
		for (k = HAS_UNLESS-1; k >= 0; k--)
		{	if (p = T0->escp[k])
			for (T1 = trans[n][p]; T1; T1 = T1->nxt)
			{	if (isthere(trans[n][i], T1->t_id))
					continue;
				T2 = cpytr(T1);
				T2->e_trans = p;
				T2->nxt = trans[n][i];
				trans[n][i] = T2;
		}	}
	 } else /* outermost unless checked first */
	 {	T4 = T3 = (Trans *) 0;
		for (T0 = trans[n][i]; T0; T0 = T0->nxt)
		for (k = HAS_UNLESS-1; k >= 0; k--)
		{	if (p = T0->escp[k])
			for (T1 = trans[n][p]; T1; T1 = T1->nxt)
			{	if (isthere(trans[n][i], T1->t_id))
					continue;
				T2 = cpytr(T1);
				T2->nxt = (Trans *) 0;
				T2->e_trans = p;
				if (T3)	T3->nxt = T2;
				else	T4 = T2;
				T3 = T2;
		}	}
		if (T4)
		{	T3->nxt = trans[n][i];
			trans[n][i] = T4;
		}
	 }
	}
#endif
#ifndef NOREDUCE
	for (i = 1; i < m; i++)
	{	if (a_cycles)
		{ /* moves through these states are visible */
	#if PROG_LAB>0 && defined(HAS_NP)
			if (progstate[n][i])
				goto degrade;
			for (T1 = trans[n][i]; T1; T1 = T1->nxt)
				if (progstate[n][T1->st])
					goto degrade;
	#endif
			if (accpstate[n][i] || visstate[n][i])
				goto degrade;
			for (T1 = trans[n][i]; T1; T1 = T1->nxt)
				if (accpstate[n][T1->st])
					goto degrade;
		}
		T1 = trans[n][i];
		if (!T1) continue;
		g = mark_safety(T1);	/* V3.3.1 */
		if (g < 0) goto degrade; /* global */
		/* check if mixing of guards preserves reduction */
		if (T1->nxt)
		{	k = 0;
			for (T0 = T1; T0; T0 = T0->nxt)
			{	if (!(T0->atom&8))
					goto degrade;
				for (aa = 0; aa < 2; aa++)
				{	j = srinc_set(T0->tpe[aa]);
					if (j >= GLOBAL && j != ALPHA_F)
						goto degrade;
					if (T0->tpe[aa]
					&&  T0->tpe[aa]
					!=  T1->tpe[0])
						k = 1;
			}	}
			/* g = 0;	V3.3.1 */
			if (k)	/* non-uniform selection */
			for (T0 = T1; T0; T0 = T0->nxt)
			for (aa = 0; aa < 2; aa++)
			{	j = srinc_set(T0->tpe[aa]);
				if (j != LOCAL)
				{	k = srunc(T0->tpe[aa], j);
					for (h = 0; h < 6; h++)
						if (T1->qu[h] == k
						&&  T1->ty[h] == j)
							break;
					if (h >= 6)
					{	T1->qu[g%6] = k;
						T1->ty[g%6] = j;
						g++;
			}	}	}
			if (g > 6)
			{	T1->qu[0] = 0;	/* turn it off */
				printf("pan: warning, line %d, ",
					srcln[i]);
			 	printf("too many stmnt types (%d)",
					g);
			  	printf(" in selection\n");
			  goto degrade;
			}
		}
		/* mark all options global if >=1 is global */
		for (T1 = trans[n][i]; T1; T1 = T1->nxt)
			if (!(T1->atom&8)) break;
		if (T1)
degrade:	for (T1 = trans[n][i]; T1; T1 = T1->nxt)
			T1->atom &= ~8;	/* mark as unsafe */
		/* can only mix 'r's or 's's if on same chan */
		/* and not mixed with other local operations */
		T1 = trans[n][i];
		if (!T1 || T1->qu[0]) continue;
		j = T1->tpe[0];
		if (T1->nxt && T1->atom&8)
		{ if (j == 5*DELTA)
		  {	printf("warning: line %d ", srcln[i]);
			printf("mixed condition ");
			printf("(defeats reduction)\n");
			goto degrade;
		  }
		  for (T0 = T1; T0; T0 = T0->nxt)
		  for (aa = 0; aa < 2; aa++)
		  if  (T0->tpe[aa] && T0->tpe[aa] != j)
		  {	printf("warning: line %d ", srcln[i]);
			printf("[%d-%d] mixed %stion ",
				T0->tpe[aa], j, 
				(j==5*DELTA)?"condi":"selec");
			printf("(defeats reduction)\n");
			printf("	'%s' <-> '%s'\n",
				T1->tp, T0->tp);
			goto degrade;
		} }
	}
#endif
	for (i = 1; i < m; i++)
	{	T2 = trans[n][i];
		if (!T2
		||  T2->nxt
		||  strncmp(T2->tp, ".(goto)", 7)
		||  !stopstate[n][i])
			continue;
		stopstate[n][T2->st] = 1;
	}
	if (state_tables && !verbose)
	{	if (dodot)
		{	char buf[256], *q = buf, *p = procname[n];
			while (*p != '\0')
			{	if (*p != ':')
				{	*q++ = *p;
				}
				p++;
			}
			*q = '\0';
			printf("digraph ");
			switch (Btypes[n]) {
			case I_PROC:  printf("init {\n"); break;
			case N_CLAIM: printf("claim_%s {\n", buf); break;
			case E_TRACE: printf("notrace {\n"); break;
			case N_TRACE: printf("trace {\n"); break;
			default:      printf("p_%s {\n", buf); break;
			}
			printf("size=\"8,10\";\n");
			printf("  GT [shape=box,style=dotted,label=\"%s\"];\n", buf);
			printf("  GT -> S%d;\n", is);
		} else
		{	switch (Btypes[n]) {
			case I_PROC:  printf("init\n"); break;
			case N_CLAIM: printf("claim %s\n", procname[n]); break;
			case E_TRACE: printf("notrace assertion\n"); break;
			case N_TRACE: printf("trace assertion\n"); break;
			default:      printf("proctype %s\n", procname[n]); break;
		}	}
		for (i = 1; i < m; i++)
		{	reach[i] = 1;
		}
		tagtable(n, m, is, srcln, reach);
		if (dodot) printf("}\n");
	} else
	for (i = 1; i < m; i++)
	{	int nrelse;
		if (Btypes[n] != N_CLAIM)
		{	for (T0 = trans[n][i]; T0; T0 = T0->nxt)
			{	if (T0->st == i
				&& strcmp(T0->tp, "(1)") == 0)
				{	printf("error: proctype '%s' ",
						procname[n]);
		  			printf("line %d, state %d: has un",
						srcln[i], i);
					printf("conditional self-loop\n");
					pan_exit(1);
		}	}	}
		nrelse = 0;
		for (T0 = trans[n][i]; T0; T0 = T0->nxt)
		{	if (strcmp(T0->tp, "else") == 0)
				nrelse++;
		}
		if (nrelse > 1)
		{	printf("error: proctype '%s' state",
				procname[n]);
		  	printf(" %d, inherits %d", i, nrelse);
		  	printf(" 'else' stmnts\n");
			pan_exit(1);
	}	}
#if !defined(LOOPSTATE) && !defined(BFS_PAR)
	if (state_tables)
#endif
	do_dfs(n, m, is, srcln, reach, lpstate);

	if (!t_reverse)
	{	return;
	}
	/* process n, with m states, is=initial state -- reverse list */
	if (!state_tables && Btypes[n] != N_CLAIM)
	{	for (i = 1; i < m; i++)
		{	Trans *Tx = (Trans *) 0; /* list of escapes */
			Trans *Ty = (Trans *) 0; /* its tail element */
			T1 = (Trans *) 0; /* reversed list */
			T2 = (Trans *) 0; /* its tail */
			T3 = (Trans *) 0; /* remembers possible 'else' */

			/* find unless-escapes, they should go first */
			T4 = T5 = T0 = trans[n][i];
	#ifdef HAS_UNLESS
			while (T4 && T4->e_trans) /* escapes are first in orig list */
			{	T5 = T4;	  /* remember predecessor */
				T4 = T4->nxt;
			}
	#endif
			/* T4 points to first non-escape, T5 to its parent, T0 to original list */
			if (T4 != T0)		 /* there was at least one escape */
			{	T3 = T5->nxt;		 /* start of non-escapes */
				T5->nxt = (Trans *) 0;	 /* separate */
				Tx = T0;		 /* start of the escapes */
				Ty = T5;		 /* its tail */
				T0 = T3;		 /* the rest, to be reversed */
			}
			/* T0 points to first non-escape, Tx to the list of escapes, Ty to its tail */

			/* first tail-add non-escape transitions, reversed */
			T3 = (Trans *) 0;
			for (T5 = T0; T5; T5 = T4)
			{	T4 = T5->nxt;
	#ifdef HAS_UNLESS
				if (T5->e_trans)
				{	printf("error: cannot happen!\n");
					continue;
				}
	#endif
				if (strcmp(T5->tp, "else") == 0)
				{	T3 = T5;
					T5->nxt = (Trans *) 0;
				} else
				{	T5->nxt = T1;
					if (!T1) { T2 = T5; }
					T1 = T5;
			}	}
			/* T3 points to a possible else, which is removed from the list */
			/* T1 points to the reversed list so far (without escapes) */
			/* T2 points to the tail element -- where the else should go */
			if (T2 && T3)
			{	T2->nxt = T3;	/* add else */
			} else
			{	if (T3) /* there was an else, but there's no tail */
				{	if (!T1)	/* and no reversed list */
					{	T1 = T3; /* odd, but possible */
					} else		/* even stranger */
					{	T1->nxt = T3;
			}	}	}

			/* add in the escapes, to that they appear at the front */
			if (Tx && Ty) { Ty->nxt = T1; T1 = Tx; }

			trans[n][i] = T1;
			/* reversed, with escapes first and else last */
	}	}
	if (state_tables && verbose)
	{	printf("FINAL proctype %s\n", 
			procname[n]);
		for (i = 1; i < m; i++)
		for (T0 = trans[n][i]; T0; T0 = T0->nxt)
			crack(n, i, T0, srcln);
	}
}
void
imed(Trans *T, int v, int n, int j)	/* set intermediate state */
{	progstate[n][T->st] |= progstate[n][v];
	accpstate[n][T->st] |= accpstate[n][v];
	stopstate[n][T->st] |= stopstate[n][v];
	mapstate[n][j] = T->st;
}
void
tagtable(int n, int m, int is, short srcln[], uchar reach[])
{	Trans *z;

	if (is >= m || !trans[n][is]
	||  is <= 0 || reach[is] == 0)
		return;
	reach[is] = 0;
	if (state_tables)
	for (z = trans[n][is]; z; z = z->nxt)
	{	if (dodot)
			dot_crack(n, is, z);
		else
			crack(n, is, z, srcln);
	}

	for (z = trans[n][is]; z; z = z->nxt)
	{
#ifdef HAS_UNLESS
		int i, j;
#endif
		tagtable(n, m, z->st, srcln, reach);
#ifdef HAS_UNLESS
		for (i = 0; i < HAS_UNLESS; i++)
		{	j = trans[n][is]->escp[i];
			if (!j) break;
			tagtable(n, m, j, srcln, reach);
		}
#endif
	}
}

extern Trans *t_id_lkup[];

void
dfs_table(int n, int m, int is, short srcln[], uchar reach[], uchar lpstate[])
{	Trans *z;

	if (is >= m || is <= 0 || !trans[n][is])
		return;
	if ((reach[is] & (4|8|16)) != 0)
	{	if ((reach[is] & (8|16)) == 16)	/* on stack, not yet recorded */
		{	lpstate[is] = 1;
			reach[is] |= 8; /* recorded */
			if (state_tables && verbose)
			{	printf("state %d line %d is a loopstate\n", is, srcln[is]);
		}	}
		return;
	}
	reach[is] |= (4|16);	/* visited | onstack */
	for (z = trans[n][is]; z; z = z->nxt)
	{	t_id_lkup[z->t_id] = z;
#ifdef HAS_UNLESS
		int i, j;
#endif
		dfs_table(n, m, z->st, srcln, reach, lpstate);
#ifdef HAS_UNLESS
		for (i = 0; i < HAS_UNLESS; i++)
		{	j = trans[n][is]->escp[i];
			if (!j) break;
			dfs_table(n, m, j, srcln, reach, lpstate);
		}
#endif
	}
	reach[is] &= ~16; /* no longer on stack */
}
void
do_dfs(int n, int m, int is, short srcln[], uchar reach[], uchar lpstate[])
{	int i;
	dfs_table(n, m, is, srcln, reach, lpstate);
	for (i = 0; i < m; i++)
		reach[i] &= ~(4|8|16);
}
void
crack(int n, int j, Trans *z, short srcln[])
{	int i;

	if (!z) return;
	printf("	state %3d -(tr %3d)-> state %3d  ",
		j, z->forw, z->st);
	printf("[id %3d tp %3d", z->t_id, z->tpe[0]);
	if (z->tpe[1]) printf(",%d", z->tpe[1]);
#ifdef HAS_UNLESS
	if (z->e_trans)
		printf(" org %3d", z->e_trans);
	else if (state_tables >= 2)
	for (i = 0; i < HAS_UNLESS; i++)
	{	if (!z->escp[i]) break;
		printf(" esc %d", z->escp[i]);
	}
#endif
	printf("]");
	printf(" [%s%s%s%s%s] %s:%d => ",
		z->atom&6?"A":z->atom&32?"D":"-",
		accpstate[n][j]?"a" :"-",
		stopstate[n][j]?"e" : "-",
		progstate[n][j]?"p" : "-",
		z->atom & 8 ?"L":"G",
		PanSource, srcln[j]);
	for (i = 0; z->tp[i]; i++)
		if (z->tp[i] == '\n')
			printf("\\n");
		else
			putchar(z->tp[i]);
	if (verbose && z->qu[0])
	{	printf("\t[");
		for (i = 0; i < 6; i++)
			if (z->qu[i])
				printf("(%d,%d)",
				z->qu[i], z->ty[i]);
		printf("]");
	}
	printf("\n");
	fflush(stdout);
}
/* spin -a m.pml; cc -o pan pan.c; ./pan -D | dot -Tps > foo.ps; ps2pdf foo.ps */
void
dot_crack(int n, int j, Trans *z)
{	int i;

	if (!z) return;
	printf("	S%d -> S%d  [color=black", j, z->st);

	if (z->atom&6) printf(",style=dashed");
	else if (z->atom&32) printf(",style=dotted");
	else if (z->atom&8) printf(",style=solid");
	else printf(",style=bold");

	printf(",label=\"");
	for (i = 0; z->tp[i]; i++)
	{	if (z->tp[i] == '\\'
		&&  z->tp[i+1] == 'n')
		{	i++; printf(" ");
		} else
		{	putchar(z->tp[i]);
	}	}
	printf("\"];\n");
	if (accpstate[n][j]) printf("  S%d [color=red,style=bold];\n", j);
	else if (progstate[n][j]) printf("  S%d [color=green,style=bold];\n", j);
	if (stopstate[n][j]) printf("  S%d [color=blue,style=bold,shape=box];\n", j);
}

#ifdef VAR_RANGES
#define BYTESIZE	32	/* 2^8 : 2^3 = 256:8 = 32 */

typedef struct Vr_Ptr {
	char	*nm;
	uchar	vals[BYTESIZE];
	struct Vr_Ptr *nxt;
} Vr_Ptr;
Vr_Ptr *ranges = (Vr_Ptr *) 0;

void
logval(char *s, int v)
{	Vr_Ptr *tmp;

	if (v<0 || v > 255) return;
	for (tmp = ranges; tmp; tmp = tmp->nxt)
		if (!strcmp(tmp->nm, s))
			goto found;
	tmp = (Vr_Ptr *) emalloc(sizeof(Vr_Ptr));
	tmp->nxt = ranges;
	ranges = tmp;
	tmp->nm = s;
found:
	tmp->vals[(v)/8] |= 1<<((v)%8);
}

void
dumpval(uchar X[], int range)
{	int w, x, i, j = -1;

	for (w = i = 0; w < range; w++)
	for (x = 0; x < 8; x++, i++)
	{
from:		if ((X[w] & (1<<x)))
		{	printf("%d", i);
			j = i;
			goto upto;
	}	}
	return;
	for (w = 0; w < range; w++)
	for (x = 0; x < 8; x++, i++)
	{
upto:		if (!(X[w] & (1<<x)))
		{	if (i-1 == j)
				printf(", ");
			else
				printf("-%d, ", i-1);
			goto from;
	}	}
	if (j >= 0 && j != 255)
		printf("-255");
}

void
dumpranges(void)
{	Vr_Ptr *tmp;
	printf("\nValues assigned within ");
	printf("interval [0..255]:\n");
	for (tmp = ranges; tmp; tmp = tmp->nxt)
	{	printf("\t%s\t: ", tmp->nm);
		dumpval(tmp->vals, BYTESIZE);
		printf("\n");
	}
}
#endif
