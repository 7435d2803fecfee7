/** How an address names a time of a run and a node: `#t=12.40&node=root/grasp`. Pure. */

export interface MomentPlace {
  /** Of the run's clock; undefined at the present, or at its end. */
  readonly timeS: number | undefined
  readonly node: string | undefined
}

export function momentText(timeS: number | undefined, node: string | undefined): string {
  return [timeS !== undefined && `t=${Number(timeS.toFixed(3))}`, node && `node=${encodeURI(node).replaceAll('&', '%26')}`]
    .filter(Boolean)
    .join('&')
}

/** What an address names; what it does not know is left out. */
export function momentOf(hash: string): MomentPlace {
  const values = new URLSearchParams(hash.replace(/^#/, '').replaceAll('+', '%2B'))
  const time = values.get('t')
  const timeS = time ? Number(time) : NaN
  return { timeS: Number.isFinite(timeS) && timeS >= 0 ? timeS : undefined, node: values.get('node') || undefined }
}
