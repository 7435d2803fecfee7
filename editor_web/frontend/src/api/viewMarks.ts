/** Marks in the 3D view of this page: what several parts of the page mark there is shown together. */
import { pageStore } from './pageStore'
import { sendToServer } from './teaching'
import type { ShowMarks } from './types'

type Marked = Partial<Pick<ShowMarks, 'points' | 'axes' | 'body'>>

const marked = pageStore<{ readonly all: ReadonlyMap<string, Marked> }>(() => ({ all: new Map() }))

/** Show these marks of one part of the page in the place of those before; none without any. */
export function showMarks(by: string, marks: Marked | undefined): void {
  const others = [...marked.getState().all].filter(([each]) => each !== by)
  const all = new Map<string, Marked>(marks ? [...others, [by, marks]] : others)
  marked.setState({ all })
  const shown = [...all.values()]
  sendToServer({
    k: 'mark',
    points: shown.flatMap((each) => each.points ?? []),
    box: null,
    axes: shown.find((each) => each.axes)?.axes ?? null,
    body: shown.find((each) => each.body)?.body ?? null,
  })
}
