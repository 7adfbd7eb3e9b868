// Random numbers that are the same each time.

export class Random {
  constructor(seed) {
    this.state = seed;
  }

  // Between 0 and 1.
  uniform() {
    this.state = (1103515245 * this.state + 12345) % 2147483648;
    return (this.state + 0.5) / 2147483648;
  }

  normal() {
    return Math.sqrt(-2 * Math.log(this.uniform())) * Math.cos(2 * Math.PI * this.uniform());
  }

  between(least, most) {
    return least + (most - least) * this.uniform();
  }
}
