/* Receives by interrupt into a ring and sends each byte back, turned around, while more come in. */
#include <8052.h>

#define SIZE 64
#define COUNT 200

__xdata __at(0x0200) unsigned char received[COUNT];
static __idata unsigned char ring[SIZE];
static volatile __data unsigned char head, sending;

void serial(void) __interrupt(4) __using(1)
{
    if (RI) {
        RI = 0;
        ring[head & (SIZE - 1)] = SBUF;
        head++;
    }
    if (TI) {
        TI = 0;
        sending = 0;
    }
}

void main(void)
{
    unsigned char tail = 0, byte;

    RCAP2H = 0xFF;
    RCAP2L = 0xCF;
    T2CON = 0x34;
    SCON = 0x50;
    IE = 0x90;
    while (tail < COUNT) {
        while (tail == head)
            ;
        byte = ring[tail & (SIZE - 1)];
        received[tail++] = byte;
        while (sending)
            ;
        sending = 1;
        SBUF = ~byte;
    }
    while (sending)
        ;
    for (;;)
        ;
}
