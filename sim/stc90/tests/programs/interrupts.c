/* Interrupts that nest, and a UART that says what they counted. Nothing that is told depends on the exact cycle. */
#include <8052.h>

__xdata __at(0x0200) volatile unsigned int counted[8];
static volatile unsigned char ticks, fast;
static volatile unsigned char sending;

/* Low priority, each 1,000 cycles. */
void slow_timer(void) __interrupt(1) __using(1)
{
    TF0 = 0;
    TR0 = 0;
    TH0 = 0xFC;
    TL0 = 0x18;
    TR0 = 1;
    ticks++;
    /* Long enough to be interrupted. */
    for (counted[1] = 0; counted[1] < 5; counted[1]++)
        ;
}

/* High priority, each 200 cycles. */
void fast_timer(void) __interrupt(3) __using(2)
{
    fast++;
    if (fast == 10)
        fast = 0;
}

void serial(void) __interrupt(4) __using(3)
{
    if (TI) {
        TI = 0;
        sending = 0;
    }
}

static void say(unsigned char byte)
{
    while (sending)
        ;
    sending = 1;
    SBUF = byte;
}

void main(void)
{
    unsigned char n, seen;

    TMOD = 0x21;
    TH0 = 0xFC;
    TL0 = 0x18;
    TH1 = 0x38;
    TL1 = 0x38;
    RCAP2H = 0xFF;
    RCAP2L = 0xCF;
    T2CON = 0x34;
    SCON = 0x50;
    PT1 = 1;
    IE = 0x9A;
    TR0 = 1;
    TR1 = 1;
    for (n = 0; n < 40; n++) {
        seen = ticks;
        while (ticks == seen)
            ;
        counted[0] = n;
        say(n * 3);
    }
    while (sending)
        ;
    IE = 0;
    counted[2] = counted[1];
    counted[3] = fast < 10;
    counted[4] = ticks >= 40;
    for (;;)
        ;
}
