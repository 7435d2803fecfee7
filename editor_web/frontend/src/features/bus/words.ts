/** Traffic in words. */
import { duration } from '../../document/time'
import type { TopicMetrics } from '../../api/types'

/** `125 Hz`, `0.5 Hz`, `on demand`; a dash where nothing comes. */
export function rateText(line: TopicMetrics | undefined): string {
  if (!line) return ''
  if (line.on_demand && line.rate_hz === 0) return 'on demand'
  if (line.rate_hz === 0) return '–'
  return `${line.rate_hz < 10 ? line.rate_hz.toFixed(1) : Math.round(line.rate_hz)} Hz`
}

/** How old the latest message is. */
export function ageText(line: TopicMetrics | undefined): string {
  if (!line) return ''
  if (line.age_s === null) return line.on_demand ? 'now' : 'never'
  return line.age_s < 1 ? 'now' : duration(Math.floor(line.age_s)).replace('.00', '').replace('.0', '')
}

/** Who holds something, in words. */
export function holderText(run: string): string {
  if (run === 'cli') return 'a person (this page or the command line)'
  if (run === 'nobody') return 'a request without a run'
  return `run ${run}`
}
