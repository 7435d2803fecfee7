/** The names under which the page keeps what the server has answered; a key is below the one that it begins with. */
import type { PastQuery, Subject } from './timeline'
import type { Breakpoint, DemonstrationBody, Watch } from './types'
import type { TaughtReference } from './teaching'

export const queryKeys = {
  behaviors: ['behaviors'],
  everyBehavior: ['behavior'],
  behavior: (id: string) => [...queryKeys.everyBehavior, id] as const,
  startData: (behavior: string, path: string) => ['start data', behavior, path] as const,
  interrupted: ['interrupted'],
  cellConnection: ['cell connection'],
  cellItems: ['cell items'],
  cellDevices: ['cell devices'],
  cellModels: ['cell models'],
  cellDocuments: ['cell documents'],
  namingBehaviors: (name: string) => ['naming behaviors', name] as const,
  names: (text: string) => ['names', text] as const,
  catalogue: ['catalogue'],
  stateSource: (state: string) => [...queryKeys.catalogue, 'source', state] as const,
  usages: (kind: string, name: string) => ['usages', kind, name] as const,
  condition: (behavior: string, point: Breakpoint) => ['condition', behavior, point] as const,

  pastRuns: ['past runs'],
  foundRuns: (query: PastQuery) => [...queryKeys.pastRuns, query] as const,
  recordings: ['recordings'],
  opened: (id: string, isRecording: boolean) => ['opened', { id, isRecording }] as const,
  comparison: (left: string, right: string) => ['comparison', left, right] as const,
  trend: (behavior: string, last: number) => ['trend', behavior, last] as const,
  lastGood: (run: string) => ['last good', run] as const,
  failure: ({ address }: Subject) => ['failure', address] as const,
  measured: ({ address }: Subject, hasEnded: boolean) => ['measured', address, hasEnded] as const,
  timelinePart: ({ address }: Subject, fromS: number, untilS: number, seq: number) =>
    ['timeline part', address, fromS, untilS, seq] as const,
  userdata: ({ address }: Subject, seq: number, watches: readonly Watch[]) => ['userdata', address, seq, watches] as const,
  recordedFields: (addresses: readonly string[]) => ['recorded fields', addresses] as const,
  recordedCurves: (asked: object) => ['recorded curves', asked] as const,

  sweeps: ['sweeps'],
  sweep: (id: string) => ['sweep', id] as const,
  sweepRun: (id: string, number: number) => ['sweep run', id, number] as const,
  shrinking: (id: string, number: number) => ['shrinking', id, number] as const,
  factors: (behavior: string) => ['factors', behavior] as const,

  /** All that the store of entries can change. */
  entries: ['entries'],
  entriesFound: (kind: string, text: string) => [...queryKeys.entries, 'found', kind, text] as const,
  entry: (kind: string, name: string) => [...queryKeys.entries, 'row', kind, name] as const,
  entryValue: (kind: string, name: string) => [...queryKeys.entries, 'value', kind, name] as const,
  entryHistory: (kind: string, name: string) => [...queryKeys.entries, 'history', kind, name] as const,
  /** Where an arm would be along something; a capture, or a revision, stays what it is. */
  fits: (arm: string, what: TaughtReference) => [...queryKeys.entries, 'fits', arm, what] as const,
  revision: (kind: string, name: string, revision: number) => ['revision', kind, name, revision] as const,
  capture: (id: number) => ['capture', id] as const,
  triggers: ['trigger document'],
  proposal: (body: DemonstrationBody) => ['proposal', body] as const,

  busListing: (shape: number | string | undefined) => ['bus', 'listing', shape] as const,
  busFields: ['bus', 'fields'],
  busForm: (of: 'request' | 'message', name: string) => ['bus', 'form', of, name] as const,

  /** All that is known of the document with this id, but for its drafts. */
  document: (id: string) => ['document', id] as const,
  versions: (id: string) => [...queryKeys.document(id), 'versions'] as const,
  comparedVersions: (id: string, before: string | undefined, after: string | undefined, draft: string) =>
    ['compared versions', id, before, after, draft] as const,
  adaptation: (id: string, names: object) => [...queryKeys.document(id), 'adaptation', names] as const,
  referrers: ['referrers'],
  referrersOf: (id: string) => [...queryKeys.referrers, id] as const,
  deleted: ['deleted documents'],
} as const
