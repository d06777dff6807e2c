/* What a firmware does with packets: a check sum, a table search, text to numbers and back. */
#include <8052.h>
#include <stdio.h>
#include <stdlib.h>

__xdata __at(0x0200) char line[64];
__xdata __at(0x0240) unsigned int sums[32];
static __code const char *__code const names[] = {"drive", "motor", "stop", "hello", "describe", "info"};
static unsigned char next;

/* CRC-16/CCITT-FALSE, bit by bit. */
static unsigned int add(unsigned int sum, unsigned char byte)
{
    unsigned char bit;

    sum ^= (unsigned int)byte << 8;
    for (bit = 0; bit < 8; bit++)
        sum = sum & 0x8000 ? sum << 1 ^ 0x1021 : sum << 1;
    return sum;
}

static unsigned int sum_of(__xdata const char *text)
{
    unsigned int sum = 0xFFFF;

    while (*text)
        sum = add(sum, *text++);
    return sum;
}

static unsigned char find(__xdata const char *text)
{
    unsigned char name, place;

    for (name = 0; name < sizeof names / sizeof names[0]; name++) {
        for (place = 0; names[name][place] && names[name][place] == text[place]; place++)
            ;
        if (!names[name][place] && text[place] == ' ')
            return name;
    }
    return 0xFF;
}

void main(void)
{
    unsigned char name;

    for (name = 0; name < 6; name++) {
        sprintf(line, "%s %d %u %lx", names[name], 1000 - 500 * (int)name, 60000u + name, 0x12345678ul << name);
        sums[next++] = sum_of(line);
        sums[next++] = find(line);
        sums[next++] = atoi(line + 6);
    }
    line[0] = 'x';
    sums[next++] = find(line);
    for (;;)
        ;
}
