/** Something that is done when it has not been asked for again for a moment. */
export class Pause {
  private due: ReturnType<typeof setTimeout> | undefined

  /** Do it after so long, in the place of what is due. */
  later(ms: number, act: () => void): void {
    this.cancel()
    this.due = setTimeout(act, ms)
  }

  cancel(): void {
    clearTimeout(this.due)
  }
}
