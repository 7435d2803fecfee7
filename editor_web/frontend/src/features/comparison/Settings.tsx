/** What two runs were started with, and the lines in which their documents differ. */
import type { DocumentDifference, ValueChange } from '../../api/types'
import { DifferenceTable } from './DifferenceTable'
import styles from './comparison.module.css'

interface SettingsProps {
  readonly settings: readonly ValueChange[]
  readonly documents: readonly DocumentDifference[]
}

export function Settings({ settings, documents }: SettingsProps) {
  return (
    <div className={styles.details}>
      <h3>Parameters, inputs, seed, clock</h3>
      {settings.length === 0 ? (
        <p className="quiet">Both runs were started with the same.</p>
      ) : (
        <DifferenceTable rows={settings} name="Setting" />
      )}
      <h3>Documents</h3>
      {documents.length === 0 && <p className="quiet">Both runs executed the same version.</p>}
      {documents.map((document) => (
        <section key={document.name} aria-label={`Differences of ${document.name}`}>
          <p className="mono">{document.name}</p>
          <pre className={styles.lines} tabIndex={0} aria-label={`Lines of ${document.name}`}>
            {document.lines.map((line, index) => (
              <div key={index} className={line.startsWith('+') ? styles.added : line.startsWith('-') ? styles.removed : undefined}>
                {line}
              </div>
            ))}
          </pre>
        </section>
      ))}
    </div>
  )
}
